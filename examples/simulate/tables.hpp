// The CSV outputs of the contract.
#pragma once

#include <ostream>

#include "run.hpp"

namespace simulate {

void write_motions(std::ostream& out, const Program& program);
void write_blocks(std::ostream& out, const Program& program, const Plan& plan);
void write_samples_header(std::ostream& out);
void write_sample(std::ostream& out, const Program& program, const Sample& sample);

}  // namespace simulate
