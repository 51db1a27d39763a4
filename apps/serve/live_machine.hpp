// What runs a program in real time, whatever its machine is.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace serve {

/// A machine that is fed with the blocks of one program.
class LiveMachine {
 public:
  /// Numbers to show, and whether the machine rests.
  struct Tick {
    std::vector<double> row;
    bool rests{};
  };

  LiveMachine() = default;
  LiveMachine(const LiveMachine&) = delete;
  LiveMachine& operator=(const LiveMachine&) = delete;
  virtual ~LiveMachine() = default;

  virtual void hold() = 0;
  virtual void resume() = 0;
  virtual void stop() = 0;
  virtual void feed_override(double share) = 0;
  virtual void rapid_override(double share) = 0;
  virtual void single_step(bool on) = 0;
  /// Gives it as many blocks as it takes, then the period's time, s.
  [[nodiscard]] virtual Tick tick(double period) = 0;
  [[nodiscard]] virtual bool finished() const = 0;
  [[nodiscard]] virtual std::optional<std::string> error() const = 0;
};

}  // namespace serve
