//! Tests of the library through its public face.
