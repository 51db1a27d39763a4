// What the library has of core/: every definition that is no template.
#include "cncplan/core/error_text-inl.hpp"
