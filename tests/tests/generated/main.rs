//! Generated cranes: identities of their functions, and cases from textbooks.

mod branches;
mod cantilever;
mod errata;
mod extremes;
mod identities;
mod motion_derivatives;
mod omissions;
mod own_crane;
mod prescribed_runs;
mod rigid_drives;
mod section_joints;
mod statics;
mod statistics;
mod stumpff;
