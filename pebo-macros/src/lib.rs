//! pebo-macros
