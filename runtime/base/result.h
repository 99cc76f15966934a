// Errors are values. A step returns Result<T>: its T, or one Error that says what is wrong and what would be
// right. Exceptions stay inside steps that call libraries that throw.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace sherd {

struct Error {
  enum class Kind {
    Failed,     ///< the step could not do its work on this input
    Input,      ///< the graph, a parameter or the command line is wrong
    Cancelled,  ///< the user asked to stop
  };
  std::string what;    ///< what is wrong, without trailing full stop
  std::string remedy;  ///< what would be right; may be empty
  std::string port;    ///< the port or parameter at fault, where one is
  Kind kind = Kind::Failed;

  /// "what; remedy", as shown behind the position.
  std::string text() const { return remedy.empty() ? what : what + "; " + remedy; }
};

/// Short for an Error of kind Failed.
inline Error failure(std::string what, std::string remedy = {}, std::string port = {}) {
  return Error{std::move(what), std::move(remedy), std::move(port), Error::Kind::Failed};
}

inline Error cancelledError() { return Error{"cancelled", {}, {}, Error::Kind::Cancelled}; }

/// A T or an Error. Reading the value of a failed Result is a programming error (std::bad_variant_access).
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit by intent
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT: implicit by intent

  bool ok() const { return !error_; }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

}  // namespace sherd

/// Returns the error of `expr` from the enclosing function, or goes on.
#define SHERD_CHECK(expr)                                                         \
  do {                                                                            \
    if (auto sherdResult = (expr); !sherdResult.ok()) return sherdResult.error(); \
  } while (false)

#define SHERD_JOIN2(a, b) a##b
#define SHERD_JOIN(a, b) SHERD_JOIN2(a, b)
/// SHERD_ASSIGN(auto mesh, readMesh(path)): declares `mesh` with the value, or returns the error.
#define SHERD_ASSIGN(declaration, expr) SHERD_ASSIGN_AS(SHERD_JOIN(sherdResult, __LINE__), declaration, expr)
#define SHERD_ASSIGN_AS(name, declaration, expr) \
  auto name = (expr);                            \
  if (!name.ok()) return name.error();           \
  declaration = std::move(name).value()
