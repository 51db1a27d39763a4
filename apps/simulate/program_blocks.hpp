// A program as the blocks that are planned.
#pragma once

#include <cstddef>
#include <vector>

#include "machine.hpp"
#include "program.hpp"

namespace simulate {

/// There is always a block: a program without motion is one of length zero.
template <class M>
struct Program : ProgramText {
  std::vector<BlockOf<M>> blocks;
  std::vector<std::size_t> motion_of;  ///< of each block; one that rests has the motion before it
};

}  // namespace simulate
