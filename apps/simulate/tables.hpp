// The CSV outputs of the contract.
#pragma once

#include <ostream>

#include "measures.hpp"
#include "support/machine_file.hpp"

namespace simulate {

void write_motions(std::ostream& out, const ProgramText& program);
/// A row for each motion.
void write_blocks(std::ostream& out, const ProgramText& program, const Measures& measures);
void write_samples_header(std::ostream& out, const support::Machine& machine);
void write_sample(std::ostream& out, const support::Machine& machine, const Sample& sample);

}  // namespace simulate
