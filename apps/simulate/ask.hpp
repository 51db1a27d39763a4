// What a row of an events file asks of what drives a program.
#pragma once

#include "events.hpp"

namespace simulate {

template <class Driver>
void ask(Driver& driver, const Event& event) {
  switch (event.request) {
    case Request::hold:
      if constexpr (requires { driver.feed_hold(); })
        return driver.feed_hold();
      else
        return driver.hold();
    case Request::resume:
      return driver.resume();
    case Request::feed:
      return driver.feed_override(event.value);
    case Request::rapid:
      return driver.rapid_override(event.value);
    case Request::stop:
      return driver.stop();
    case Request::step:
      return driver.single_step(event.value != 0.0);
    case Request::pause:
      return driver.pause_at(static_cast<int>(event.value));
  }
}

}  // namespace simulate
