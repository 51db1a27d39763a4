// What is wrong with a block that was made by hand, whatever the machine.
#include "fault.hpp"
#include "planned.hpp"
#include "sizes.hpp"

namespace cncplan::python {

void check(const AnyBlock& block) {
  with_size(block.axes, [&](auto n) { (void)block_of<n>(block); });
}

}  // namespace cncplan::python
