#pragma once

#include <cstdlib>
#include <utility>
#include <variant>

namespace glidehelm {

/// Wraps an error on its way into an Expected: `return unexpected(SomeError{…});`
template <class E>
struct Unexpected {
  E error;
};
template <class E>
Unexpected<std::decay_t<E>> unexpected(E&& error) {
  return {std::forward<E>(error)};
}

/// A value or the reason why there is none (std::expected is C++23). T and E are different types.
/// Reading the wrong side is a bug of ours and aborts.
template <class T, class E>
class [[nodiscard]] Expected {
 public:
  using value_type = T;
  using error_type = E;

  Expected(T value) : state_{std::in_place_index<0>, std::move(value)} {}  // NOLINT(google-explicit-constructor)
  Expected(Unexpected<E> error)
      : state_{std::in_place_index<1>, std::move(error.error)} {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  [[nodiscard]] const T& value() const& {
    if (!has_value()) std::abort();
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T& value() & {
    if (!has_value()) std::abort();
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T&& value() && { return std::move(value()); }
  [[nodiscard]] const E& error() const {
    if (has_value()) std::abort();
    return *std::get_if<1>(&state_);
  }
  [[nodiscard]] T value_or(T other) const { return has_value() ? value() : std::move(other); }

  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }

 private:
  std::variant<T, E> state_;
};

/// Success without a value.
struct Done {
  friend constexpr bool operator==(Done, Done) = default;
};

}  // namespace glidehelm
