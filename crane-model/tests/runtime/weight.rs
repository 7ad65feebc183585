//! Cranes written by hand behind one pointer.

use crate::common::Sledge;
use crane_model::dyn_crane::{DynCrane, Instance};

#[test]
fn the_weight_follows_live_gravity() {
    let mut crane: Box<dyn DynCrane> = Box::new(Instance(Sledge::default()));
    for gravity in [9.81, 1.62] {
        crane.set_parameter(0, gravity).expect("any number");
        let [x, y, z] = crane.weight_at(&[0.1, 0.2]);
        // The base does not move along y. A few roundings of the weight.
        assert_eq!(y, None);
        let expected = Sledge { gravity }.weight();
        let error = (x.expect("a way along x") - expected.x).hypot(z.expect("a way along z") - expected.z);
        assert!(error < 1e-13, "{error:e} N");
    }
}
