// Names the seed of the random numbers behind every test that fails, so that it can be run again with it.
#include <iostream>

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using ListenerBase = Catch::EventListenerBase;
#else
#define CATCH_CONFIG_EXTERNAL_INTERFACES
#include <catch2/catch.hpp>
using ListenerBase = Catch::TestEventListenerBase;
#endif

#include "support/random.hpp"

namespace {

struct SeedListener : ListenerBase {
  using ListenerBase::ListenerBase;

  void testCaseEnded(const Catch::TestCaseStats& test) override {
    if (!test.totals.assertions.allOk())
      std::cout << "again with CNCPLAN_SEED=" << cncplan::test::seed() << '\n';
  }
};

}  // namespace

CATCH_REGISTER_LISTENER(SeedListener)
