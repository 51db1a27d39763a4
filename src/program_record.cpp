// What a program's text says beside its blocks.
#include "cncplan/plan/program_record-inl.hpp"
