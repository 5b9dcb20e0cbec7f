//! `gimbal`
fn main() {}
