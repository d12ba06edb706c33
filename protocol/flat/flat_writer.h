/// Writes a message as one flat segment, byte for byte as Cap'n Proto's own library does: structs
/// and lists stand in the order in which a message's list of fields comes to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/flat/flat_reader.h"

namespace huestep::protocol::flat {

/// The same calls as FlatReader's, the other way. Values beyond limits are written all the same.
class FlatWriter {
 public:
    static constexpr bool reads = false;

    /// Leaves `before` zero bytes in front of the segment.
    explicit FlatWriter(std::size_t before) : m_before(before), m_bytes(before + 8) {}

    template <class F>
    void root(Layout layout, F&& f) {
        inStruct(addStruct(m_before, layout), layout, f);
    }

    template <class T>
    void number(const char*, std::size_t byte, const T& value,
                std::type_identity_t<T> standard = {}) {
        const auto bits = bitsOf(value) ^ bitsOf(standard);
        store(m_bytes, m_now + byte, static_cast<decltype(bitsOf(value))>(bits));
    }
    void flag(std::size_t bit, bool value, bool standard = false) {
        if (value == standard) return;
        m_bytes[m_now + bit / 8] |= static_cast<std::byte>(1u << bit % 8);
    }
    template <class Enum>
    void choice(const char* field, std::size_t byte, Enum value, Enum) {
        number(field, byte, static_cast<std::uint16_t>(value));
    }
    void text(const char*, std::size_t pointer, std::string_view value, std::size_t) {
        if (value.empty()) return;
        const std::size_t at = addList(pointer, 2, value.size() + 1, value.size() + 1);
        std::memcpy(m_bytes.data() + at, value.data(), value.size());
    }
    template <class T>
    void numbers(const char*, std::size_t pointer, const std::vector<T>& values, std::size_t) {
        if (values.empty()) return;
        const unsigned code = sizeof(T) == 1 ? 2 : sizeof(T) == 4 ? 4 : 5;
        const std::size_t bytes = values.size() * sizeof(T);
        const std::size_t at = addList(pointer, code, values.size(), bytes);
        std::memcpy(m_bytes.data() + at, values.data(), bytes);
    }
    template <class T, class Each>
    void structs(const char*, std::size_t pointer, Layout layout, const std::vector<T>& values,
                 std::size_t, Each&& each) {
        if (values.empty()) return;
        std::size_t at = addComposite(pointer, layout, values.size());
        for (const T& value : values) {
            inStruct(at, layout, [&] { each(value); });
            at += 8 * layout.words();
        }
    }
    template <class F>
    void structure(const char*, std::size_t pointer, Layout layout, F&& f) {
        inStruct(addStruct(m_pointers + 8 * pointer, layout), layout, f);
    }
    void check(const char*, bool, std::string_view) {}

    std::vector<std::byte> take() { return std::move(m_bytes); }

 private:
    template <class F>
    void inStruct(std::size_t at, Layout layout, F&& f) {
        const std::size_t now = m_now, pointers = m_pointers;
        m_now = at;
        m_pointers = at + 8u * layout.dataWords;
        f();
        m_now = now;
        m_pointers = pointers;
    }
    /// Each adds words at the end, makes a pointer lead there, and says where they are.
    std::size_t addStruct(std::size_t pointer, Layout layout);
    std::size_t addList(std::size_t pointer, unsigned code, std::size_t count, std::size_t bytes);
    std::size_t addComposite(std::size_t pointer, Layout layout, std::size_t count);
    std::size_t add(std::size_t pointer, std::size_t words, unsigned kind, std::uint32_t high);

    std::size_t m_before;
    std::vector<std::byte> m_bytes;
    std::size_t m_now = 0;       ///< of the struct being written
    std::size_t m_pointers = 0;  ///< of its pointers
};

}  // namespace huestep::protocol::flat
