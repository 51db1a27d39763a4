// The flat program as rows of the 4-axis machine.
#pragma once

#include <string>
#include <vector>

#include "artwork.hpp"
#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "options.hpp"

namespace tire_mold {

struct Conversion {
  std::string text;                               ///< the program for the machine
  std::vector<cncplan::VectorN<double, 4>> rows;  ///< R, Z, A, C of each row, mm and rad
  std::size_t points = 0;                         ///< programmed points that were mapped
  double chord_error = 0.0;                       ///< mm
};

/// What the program asks of the table, rad: its least and greatest angle where the first is the one nearest
/// to 0, and the whole turns that are added to all of them.
struct TableTurns {
  double low{};
  double high{};
  double added{};
};

/// Throws `Failure` for points beyond the profile and beyond the machine's travel, by line.
[[nodiscard]] Conversion convert(const Artwork& artwork, const cncplan::kinematics::Sidewall& sidewall,
                                 const Machine& machine, const Options& options, const TableTurns& table);

/// Whether a move is the first that leads somewhere over the mold: what comes before it is not mapped.
[[nodiscard]] bool leads_to_mold(const Move& move);

/// What is mapped of the first move: its end; with `--approach`, if it is straight, its way from where it
/// comes over the profile. It begins on the origin's axis, so its radius grows evenly.
[[nodiscard]] ArtworkPath first_way(const ArtworkPath& segment, const cncplan::kinematics::Sidewall& sidewall,
                                    const Machine& machine, const Options& options);

/// Says where and why a segment cannot be mapped.
[[noreturn]] void refuse_move(const Artwork& artwork, std::size_t line, const Move& move,
                              const cncplan::Error& error);

}  // namespace tire_mold
