// A function that is called through a pointer, so that who calls it is compiled once.
#pragma once

#include <concepts>
#include <type_traits>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

template <class Signature>
class FunctionRef;

/// Any function object with this signature; a view: the object must outlive it. No heap.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, FunctionRef> && std::is_object_v<std::remove_cvref_t<F>> &&
             std::is_invocable_r_v<Result, F&, Arguments...>)
  FunctionRef(F&& function)  // NOLINT: a function is one
      : object_(const_cast<void*>(static_cast<const void*>(&function))),
        call_([](void* object, Arguments... arguments) -> Result {
          return (*static_cast<std::remove_reference_t<F>*>(object))(arguments...);
        }) {}

  Result operator()(Arguments... arguments) const { return call_(object_, arguments...); }

 private:
  void* object_;
  Result (*call_)(void*, Arguments...);
};

}  // namespace cncplan
