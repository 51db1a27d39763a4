// What a program's text says beside its blocks, its arcs, and what is wrong with it.
#include "cncplan/program_record-inl.hpp"

#include "cncplan/arc_words-inl.hpp"
#include "cncplan/program_error-inl.hpp"
