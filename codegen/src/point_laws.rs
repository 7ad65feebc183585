//! The table of laws between two points whose numbers are all constant or live: their keys in the spec language, limits and units. The
//! types of the spec, those of the chain, their check, and their dispatch in the mechanics are expanded from it.
//!
//! Every law has a `length` without force. A key that may be left out is then 0.

macro_rules! point_laws {
    ($expand:ident) => {
        $expand! {
            /// A spring and a damper, which pull and push.
            Spring as PointSpring: "a mapping of `stiffness`, `damping` and `length`" {
                /// Stiffness.
                #[key(unit = "N/m", limit = NotNegative)]
                stiffness: Spanned<Number>;
                /// Damping. Default 0.
                #[key(unit = "N s/m", limit = NotNegative)]
                damping: Option<Spanned<Number>>;
                /// Length at which the spring exerts no force.
                #[key(unit = "m", limit = Positive)]
                length: Spanned<Number>;
            }
            /// A gas spring, which pushes.
            GasSpring as GasSpring: "a mapping of `force`, `length`, `stiffness` and `damping`" {
                /// The force with which it pushes at `length`.
                #[key(unit = "N", limit = NotNegative)]
                force: Spanned<Number>;
                /// Length of the extended spring.
                #[key(unit = "m", limit = Positive)]
                length: Spanned<Number>;
                /// Increase of the force per metre of compression. Default 0.
                #[key(unit = "N/m", limit = NotNegative)]
                stiffness: Option<Spanned<Number>>;
                /// Damping. Default 0.
                #[key(unit = "N s/m", limit = NotNegative)]
                damping: Option<Spanned<Number>>;
            }
            /// A progressive spring, which becomes stiffer the further it is stretched or compressed, and a damper.
            ProgressiveSpring as ProgressiveSpring: "a mapping of `stiffness`, `progression`, `length` and `damping`" {
                /// Stiffness at `length`.
                #[key(unit = "N/m", limit = NotNegative)]
                stiffness: Spanned<Number>;
                /// Force per cubed metre of stretch, in addition to that of `stiffness`.
                #[key(unit = "N/m³", limit = NotNegative)]
                progression: Spanned<Number>;
                /// Length at which the spring exerts no force.
                #[key(unit = "m", limit = Positive)]
                length: Spanned<Number>;
                /// Damping. Default 0.
                #[key(unit = "N s/m", limit = NotNegative)]
                damping: Option<Spanned<Number>>;
            }
        }
    };
}
