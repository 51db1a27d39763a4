// The CSV outputs of the contract.
#pragma once

#include <ostream>

#include "run.hpp"

namespace simulate {

void write_motions(std::ostream& out, const Program& program);
/// A row for each motion: `blocks` says which block of the program each piece of the plan belongs to.
void write_blocks(std::ostream& out, const Program& program, const Plan& plan,
                  const std::vector<std::size_t>& blocks);
void write_samples_header(std::ostream& out, const Machine& machine);
void write_sample(std::ostream& out, const Program& program, const Machine& machine, const Sample& sample);

}  // namespace simulate
