// What a program's text says beside its blocks, its arcs, and what is wrong with it.
#include "cncplan/plan/program_record-inl.hpp"

#include "cncplan/plan/arc_words-inl.hpp"
#include "cncplan/plan/program_error-inl.hpp"
