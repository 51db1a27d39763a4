// Any junction policy, called through a pointer, so that who asks it is compiled once.
#pragma once

#include <concepts>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// A junction policy in place of another one. It is a view: the policy must outlive it. No heap.
template <std::floating_point S>
class BasicPolicyRef {
 public:
  template <JunctionPolicy<S> P>
    requires(!std::same_as<P, BasicPolicyRef>)
  BasicPolicyRef(const P& policy)  // NOLINT: a policy is one
      : policy_(&policy), speed_sq_([](const void* of, const BasicGeometry<S>& junction) -> S {
          return static_cast<const P*>(of)->speed_sq(junction);
        }) {}
  template <JunctionPolicy<S> P>
    requires(!std::same_as<P, BasicPolicyRef>)
  BasicPolicyRef(const P&& policy)
  = delete;  // which would not outlive it

  [[nodiscard]] S speed_sq(const BasicGeometry<S>& junction) const { return speed_sq_(policy_, junction); }

 private:
  const void* policy_;
  S (*speed_sq_)(const void*, const BasicGeometry<S>&);
};

using PolicyRef = BasicPolicyRef<double>;

}  // namespace cncplan::junction
