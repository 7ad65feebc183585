//! The table of laws between two points whose numbers are all constant or live: their keys in the spec language, limits and units. The
//! types of the spec, those of the chain, their check, and their dispatch in the mechanics are expanded from it.
//!
//! Every law has a `length` without force. A key that may be left out is then 0.

macro_rules! point_laws {
    ($expand:ident) => {
        $expand! {
            /// A spring and a damper, which pull and push.
            Spring as PointSpring: "a mapping of `stiffness`, `damping` and `length`" {
                /// Stiffness, N/m.
                stiffness: Spanned<Number>, NotNegative "N/m";
                /// Damping, N s/m. Default 0.
                damping: Option<Spanned<Number>>, NotNegative "N s/m";
                /// Length at which the spring exerts no force, m.
                length: Spanned<Number>, Positive "m";
            }
            /// A gas spring, which pushes.
            GasSpring as GasSpring: "a mapping of `force`, `length`, `stiffness` and `damping`" {
                /// The force with which it pushes at `length`, N.
                force: Spanned<Number>, NotNegative "N";
                /// Length of the extended spring, m.
                length: Spanned<Number>, Positive "m";
                /// Increase of the force per metre of compression, N/m. Default 0.
                stiffness: Option<Spanned<Number>>, NotNegative "N/m";
                /// Damping, N s/m. Default 0.
                damping: Option<Spanned<Number>>, NotNegative "N s/m";
            }
            /// A progressive spring, which becomes stiffer the further it is stretched or compressed, and a damper.
            ProgressiveSpring as ProgressiveSpring: "a mapping of `stiffness`, `progression`, `length` and `damping`" {
                /// Stiffness at `length`, N/m.
                stiffness: Spanned<Number>, NotNegative "N/m";
                /// Force per cubed metre of stretch, in addition to that of `stiffness`, N/m³.
                progression: Spanned<Number>, NotNegative "N/m³";
                /// Length at which the spring exerts no force, m.
                length: Spanned<Number>, Positive "m";
                /// Damping, N s/m. Default 0.
                damping: Option<Spanned<Number>>, NotNegative "N s/m";
            }
        }
    };
}
