//! Tests on analytic fields.
