// The words of an output port, bit by bit.
#include "cncplan/step/port.hpp"

#include <array>

#include "support/catch.hpp"

using namespace cncplan;
using step::Drive;
using step::Tick;

TEST_CASE("a port's word holds step bits below and direction bits above, inverted where the drive is") {
  const step::PortRegister plain(std::array{Drive{}, Drive{}, Drive{}});
  CHECK(plain.high(Tick{7, 0b101, 0b110}) == 0b110'101);
  CHECK(plain.low(Tick{7, 0b101, 0b110}) == 0b110'000);
  const step::PortRegister mixed(std::array{Drive{.inverted = true}, Drive{}, Drive{.inverted = true}});
  CHECK(mixed.high(Tick{7, 0b101, 0b110}) == 0b011'101);
  CHECK(mixed.low(Tick{7, 0b000, 0b000}) == 0b101'000);
}

TEST_CASE("a port of few axes leaves the other pins low") {
  const step::PortRegister one(std::array{Drive{}});
  CHECK(one.high(Tick{0, ~0u, ~0u}) == 0b11);
  const step::PortRegister sixteen(std::array<Drive, 16>{});
  CHECK(sixteen.high(Tick{0, 1, ~0u}) == 0xffff0001);
}
