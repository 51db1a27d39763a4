#include "support/no_heap.hpp"

#include <Eigen/Core>
#include <array>
#include <memory>
#include <new>
#include <vector>

#include "support/catch.hpp"

using cncplan::test::heap_allocations_of;

namespace {

// Out of the optimiser's sight, which may remove an allocation that nothing uses.
void use(void* memory) { asm volatile("" : : "r"(memory) : "memory"); }

}  // namespace

TEST_CASE("code that keeps off the heap counts nothing") {
  std::array<double, 64> values{};
  CHECK(heap_allocations_of([&] { use(values.data()); }) == 0);
  CHECK(heap_allocations_of([] {
          Eigen::Vector3d point = Eigen::Vector3d::Ones();
          use(point.data());
        }) == 0);
}

TEST_CASE("every way to the heap is counted") {
  CHECK(heap_allocations_of([] { use(std::make_unique<int>(7).get()); }) == 1);
  CHECK(heap_allocations_of([] { use(std::make_unique<int[]>(7).get()); }) == 1);
  CHECK(heap_allocations_of([] { use(std::vector<double>(3).data()); }) == 1);
  CHECK(heap_allocations_of([] { use(std::unique_ptr<int>(new (std::nothrow) int).get()); }) == 1);
  struct alignas(128) Wide {
    double value;
  };
  CHECK(heap_allocations_of([] { use(std::make_unique<Wide>().get()); }) == 1);
  CHECK(heap_allocations_of([] {
          Eigen::VectorXd vector(9);
          use(vector.data());
        }) == 1);
  CHECK(heap_allocations_of([] {
          void* memory = std::malloc(8);
          use(memory);
          std::free(memory);
        }) == 1);
}
