/// A value or a sentence about why there is none.
///
/// Bytes, files and users get a `Result`; our own bugs get an `assert` (see style: "assert our
/// bugs, answer the world's"). The core is built to work without exceptions.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace huestep {

/// One sentence for a person: what is wrong, where, and what would be right.
struct Error {
    std::string message;
};

/// Holds a `T` or an `Error`. Thread rule: a plain value.
template <class T>
class [[nodiscard]] Result {
 public:
    Result(T value) : m_content(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : m_content(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return m_content.index() == 0; }
    explicit operator bool() const { return ok(); }

    /// The value. Requires `ok()`.
    [[nodiscard]] T& value() & {
        assert(ok());
        return *std::get_if<0>(&m_content);
    }
    [[nodiscard]] const T& value() const& {
        assert(ok());
        return *std::get_if<0>(&m_content);
    }
    [[nodiscard]] T&& value() && {
        assert(ok());
        return std::move(*std::get_if<0>(&m_content));
    }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// The reason. Requires `!ok()`.
    [[nodiscard]] const Error& error() const {
        assert(!ok());
        return *std::get_if<1>(&m_content);
    }

 private:
    std::variant<T, Error> m_content;
};

/// The result of an action that yields nothing.
struct Done {};
using Status = Result<Done>;

}  // namespace huestep
