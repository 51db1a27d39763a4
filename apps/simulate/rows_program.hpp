// Programs that name the axes of the machine with a tilting spindle.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/plan_options.hpp"
#include "cncplan/program_record.hpp"
#include "machine.hpp"

namespace simulate {

/// Rows R Z A C as blocks along which the tip's way is counted; as `cncplan::Program` has it otherwise.
class RowsProgram : public cncplan::ProgramRecord {
 public:
  /// The options have a dialect.
  RowsProgram(std::string_view text, const Rows& machine, const cncplan::PlanOptions& options,
              const std::string& file);

  [[nodiscard]] const std::vector<BlockOf<Rows>>& blocks() const { return blocks_; }
  [[nodiscard]] std::vector<BlockOf<Rows>> take_blocks() && { return std::move(blocks_); }

 private:
  [[nodiscard]] cncplan::Expected<std::size_t, cncplan::ProgramError> keep(const BlockOf<Rows>& block,
                                                                           const Rows& machine);

  std::vector<BlockOf<Rows>> blocks_;
};

}  // namespace simulate
