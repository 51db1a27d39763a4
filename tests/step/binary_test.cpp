// The compact stream: its documented bytes, every edge back, and broken streams refused.
#include "cncplan/step/binary.hpp"

#include <cmath>
#include <iterator>
#include <vector>

#include "cncplan/step/backend.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using step::BinaryReader;
using step::Edge;
using Bytes = std::vector<std::uint8_t>;

static_assert(step::Backend<step::BinaryWriter<std::back_insert_iterator<Bytes>>>);

TEST_CASE("the bytes of the example in the documentation") {
  Bytes bytes;
  step::BinaryWriter writer(std::back_inserter(bytes));
  REQUIRE(writer.accept({1e-6, 0, 1}));
  REQUIRE(writer.accept({1.001e-6, 2, -1}));
  // 1000 << 4 | 0 << 1 | 1 = 16001 = 0x7d << 7 | 1;  1 << 4 | 2 << 1 | 0 = 20
  CHECK(bytes == Bytes{'C', 'N', 'C', 'S', 1, 0x81, 0x7d, 0x14});
}

TEST_CASE("edges come back to the nanosecond") {
  test::Random random;
  Bytes bytes;
  std::vector<Edge> edges;
  step::BinaryWriter writer(std::back_inserter(bytes));
  double time = 0.0;
  for (int i = 0; i < 20000; ++i) {
    time += random.coin() ? 0.0 : random.log_uniform(1e-9, 1e3);
    edges.push_back({time, random.integer(0, 7), random.coin() ? 1 : -1});
    if (!writer.accept(edges.back())) FAIL("edge " << i << " is refused");
  }
  auto reader = BinaryReader::make(bytes);
  REQUIRE(reader);
  double worst = 0.0;
  for (const Edge& edge : edges) {
    const auto read = reader->next();
    if (!read || !*read) FAIL("the stream ends early");
    if ((*read)->axis != edge.axis || (*read)->direction != edge.direction) FAIL("another edge");
    worst = std::max(worst, std::abs((*read)->time - edge.time) - 1e-15 * edge.time);
  }
  CHECK(worst <= 0.5001e-9);
  CHECK_FALSE(reader->next()->has_value());
}

TEST_CASE("edges that the format cannot hold are refused") {
  Bytes bytes;
  step::BinaryWriter writer(std::back_inserter(bytes));
  REQUIRE(writer.accept({2.0, 7, 1}));
  CHECK(writer.accept({1.0, 0, 1}).error() == Error{ErrorCode::below_limit, "edge time", 1.0, 2.0});
  CHECK(writer.accept({-1e300, 0, 1}).error().code == ErrorCode::below_limit);
  CHECK(writer.accept({1e12, 0, 1}).error().code == ErrorCode::above_limit);
  CHECK(writer.accept({NAN, 0, 1}).error().field == "edge time");
  CHECK(writer.accept({3.0, 8, 1}).error() == Error{ErrorCode::above_limit, "edge axis", 8.0, 7.0});
  CHECK(writer.accept({3.0, -1, 1}).error() == Error{ErrorCode::negative, "edge axis", -1.0, 0.0});
  for (const int direction : {0, 2, 5, -2})
    CHECK(writer.accept({3.0, 0, direction}).error().field == "edge direction");
  CHECK(bytes.size() == 5 + 5);
}

TEST_CASE("an edge that rounds to time 0 falls on it, an earlier one is refused") {
  Bytes bytes;
  step::BinaryWriter writer(std::back_inserter(bytes));
  CHECK(writer.accept({-0.6e-9, 0, 1}).error().code == ErrorCode::below_limit);
  REQUIRE(writer.accept({-0.5e-9, 0, 1}));
  REQUIRE(writer.accept({0.4e-9, 0, -1}));
  CHECK(writer.accept({0.3e-9, 0, -1}).error() == Error{ErrorCode::below_limit, "edge time", 0.3e-9, 0.4e-9});
  CHECK(bytes == Bytes{'C', 'N', 'C', 'S', 1, 0x01, 0x00});
}

TEST_CASE("a broken stream is an error with its place, never an edge") {
  const Error at_zero{ErrorCode::malformed, "step stream", 0.0, 0.0};
  CHECK(BinaryReader::make({}).error() == at_zero);
  CHECK(BinaryReader::make(Bytes{'X', 'N', 'C', 'S', 1}).error() == at_zero);
  CHECK(BinaryReader::make(Bytes{'C', 'N', 'C', 'S', 2}).error().value == 4.0);
  const Bytes cut{'C', 'N', 'C', 'S', 1, 0x14, 0x81};
  auto reader = *BinaryReader::make(cut);
  CHECK(**reader.next() == Edge{1e-9, 2, -1});
  CHECK(reader.next().error() == Error{ErrorCode::malformed, "step stream", 6.0, 0.0});
  const Bytes endless{'C', 'N', 'C', 'S', 1, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f};
  CHECK_FALSE(BinaryReader::make(endless)->next());
  Bytes late{'C', 'N', 'C', 'S', 1};
  for (int i = 0; i < 40; ++i)
    late.insert(late.end(), {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f});
  auto overflowing = *BinaryReader::make(late);
  int edges = 0;
  while (overflowing.next()) ++edges;
  CHECK(edges == 16);
}
