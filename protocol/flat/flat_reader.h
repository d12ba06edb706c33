/// Reads a message of one flat segment where Cap'n Proto's own library cannot be: it needs
/// exceptions, threads and signals, which WebAssembly as it is built here has not.
///
/// A message's list of fields (flat/fields.h) goes over it with the places that the schema gives
/// them. Nothing is thrown: the first thing that is wrong is kept as a sentence, and from then on
/// numbers mean nothing and lists are empty. Every pointer is checked against the segment, every
/// size against its limit before anything is made of it, and what is made of a message is held to
/// four times its words, as with the library.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/result.h"
#include "protocol/bytes.h"

namespace huestep::protocol::flat {

/// Size of a struct of a schema.
struct Layout {
    std::uint16_t dataWords = 0;
    std::uint16_t pointers = 0;
    [[nodiscard]] constexpr std::size_t words() const { return std::size_t{dataWords} + pointers; }
};

/// The unsigned number with a value's bits: what is stored is that of the standard one, exclusively
/// or'ed, so that zeros mean standard values.
template <class T>
auto bitsOf(T value) {
    if constexpr (std::is_same_v<T, float>) {
        return std::bit_cast<std::uint32_t>(value);
    } else {
        return static_cast<std::make_unsigned_t<T>>(value);
    }
}

class FlatReader {
 public:
    static constexpr bool reads = true;

    /// `name`: of the message, in front of every sentence. The segment must outlive the reader.
    FlatReader(std::string_view name, std::span<const std::byte> segment);

    /// Does `f` with the root as the struct whose fields are read.
    template <class F>
    void root(Layout, F&& f) {
        inStruct(structAt("", 0), f);
    }

    /// A number at a place in bytes; floats must be finite.
    template <class T>
    void number(const char* field, std::size_t byte, T& value,
                std::type_identity_t<T> standard = {}) {
        using Bits = decltype(bitsOf(standard));
        Bits bits{};
        if (byte + sizeof(T) <= m_now.dataBytes) {
            bits = load<Bits>(m_segment, m_now.data + byte);
        }
        bits = static_cast<Bits>(bits ^ bitsOf(standard));
        if constexpr (std::is_same_v<T, float>) {
            value = std::bit_cast<float>(bits);
            check(field, std::isfinite(value), "not a finite number");
            if (m_error) value = standard;
        } else {
            value = static_cast<T>(bits);
        }
    }
    /// A bit at a place in bits.
    void flag(std::size_t bit, bool& value, bool standard = false);

    /// An enumerant at a place in bytes, checked against the highest that is known.
    template <class Enum>
    void choice(const char* field, std::size_t byte, Enum& value, Enum last) {
        std::uint16_t bits = 0;
        number(field, byte, bits);
        check(field, bits <= static_cast<std::uint16_t>(last), "unknown value");
        value = m_error ? Enum{} : static_cast<Enum>(bits);
    }

    /// UTF-8 text without control characters, at most `most` bytes.
    void text(const char* field, std::size_t pointer, std::string& value, std::size_t most);

    /// Bytes, or numbers of 4 or 8.
    template <class T>
    void numbers(const char* field, std::size_t pointer, std::vector<T>& values, std::size_t most) {
        const List list = listAt(field, pointer, codeOf(sizeof(T)));
        const std::size_t count = countOf(field, list, most, sizeof(T));
        values.resize(count);
        if (count > 0) std::memcpy(values.data(), m_segment.data() + list.at, count * sizeof(T));
    }

    /// A list of structs: `each(element)` with the struct as the one whose fields are read.
    template <class T, class Each>
    void structs(const char* field, std::size_t pointer, Layout layout, std::vector<T>& values,
                 std::size_t most, Each&& each) {
        const List list = listAt(field, pointer, composite);
        const std::size_t count = countOf(field, list, most, 8 * layout.words());
        values.resize(count);
        for (std::size_t i = 0; i < count && !m_error; ++i) {
            const Step step(*this, field, i);
            inStruct({list.at + 8 * i * list.layout.words(), 8u * list.layout.dataWords,
                      list.layout.pointers},
                     [&] { each(values[i]); });
        }
        if (m_error) values.clear();
    }

    /// A struct of its own: `f()` with it as the one whose fields are read.
    template <class F>
    void structure(const char* field, std::size_t pointer, Layout, F&& f) {
        const Step step(*this, field, noIndex);
        inStruct(pointer < m_now.pointers ? structAt(field, pointerAt(pointer)) : Struct{}, f);
    }

    /// Refuses the message unless `holds`.
    void check(const char* field, bool holds, std::string_view otherwise);

    [[nodiscard]] const std::optional<Error>& error() const { return m_error; }

 private:
    static constexpr std::size_t noIndex = ~std::size_t{0};
    static constexpr unsigned composite = 7;
    static constexpr unsigned codeOf(std::size_t bytes) {
        return bytes == 1 ? 2 : bytes == 4 ? 4 : 5;
    }

    /// Places in bytes from the segment's start; one without words holds standard values.
    struct Struct {
        std::size_t data = 0;
        std::size_t dataBytes = 0;
        std::size_t pointers = 0;
    };
    struct List {
        std::size_t at = 0;
        std::size_t count = 0;
        Layout layout;  ///< of composite elements
    };
    /// A step of the way from the root to the field being read.
    class Step {
     public:
        Step(FlatReader& reader, const char* field, std::size_t index) : m_reader(reader) {
            if (reader.m_depth < reader.m_path.size())
                reader.m_path[reader.m_depth] = {field, index};
            ++reader.m_depth;
        }
        ~Step() { --m_reader.m_depth; }
        Step(const Step&) = delete;
        Step& operator=(const Step&) = delete;

     private:
        FlatReader& m_reader;
    };

    template <class F>
    void inStruct(Struct inner, F&& f) {
        const Struct outer = m_now;
        m_now = inner;
        f();
        m_now = outer;
    }
    /// Where a pointer of the struct being read stands, in bytes.
    [[nodiscard]] std::size_t pointerAt(std::size_t index) const {
        return m_now.data + m_now.dataBytes + 8 * index;
    }
    Struct structAt(const char* field, std::size_t pointer);
    List listAt(const char* field, std::size_t index, unsigned code);
    List compositeAt(const char* field, std::size_t at, std::size_t words);
    std::size_t countOf(const char* field, const List& list, std::size_t most, std::size_t bytes);
    /// Whether `words` words from `at` bytes on lie in the segment, and may still be visited.
    bool visit(const char* field, std::int64_t at, std::size_t words);

    std::string_view m_name;
    std::span<const std::byte> m_segment;
    Struct m_now;
    std::size_t m_mayVisit;  ///< words
    std::size_t m_mayMake;   ///< words
    struct Way {
        const char* field = "";
        std::size_t index = 0;
    };
    std::array<Way, 8> m_path{};
    std::size_t m_depth = 0;
    std::optional<Error> m_error;
};

}  // namespace huestep::protocol::flat
