/// Reading hostile Cap'n Proto messages: where we are, what is allowed, how a refusal is said.
///
/// Our refusals (trail.h) and Cap'n Proto's own are exceptions; both are caught in `readMessage`,
/// the one border, and never leave it.
#pragma once

#include <capnp/message.h>
#include <capnp/schema.h>
#include <kj/exception.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "core/result.h"
#include "protocol/trail.h"

namespace huestep::protocol::wire {

/// Pointers from the root to the deepest field: Frame, list, command, spawn, list, body, list,
/// shape, list, vertex. Eight would do if a spawn's lists stood in the command and a vertex were
/// two numbers of a flat list; names that people know from scene files are worth two levels, and
/// no schema here is recursive, so the schema itself bounds the depth that our code ever walks.
inline constexpr int nestingLimit = 10;

/// Words of a struct without what it points to.
template <class Schema>
std::size_t structWords() {
    static const std::size_t words = [] {
        const auto layout = ::capnp::Schema::from<Schema>().getProto().getStruct();
        return std::size_t{layout.getDataWordCount()} + layout.getPointerCount();
    }();
    return words;
}

template <class Schema>
std::size_t structBytes() {
    return 8 * structWords<Schema>();
}

/// Words of a list of structs: a tag, then the structs.
template <class Schema>
std::size_t structListWords(std::size_t count) {
    return count == 0 ? 0 : 1 + count * structWords<Schema>();
}
inline std::size_t byteWords(std::size_t bytes) {
    return (bytes + 7) / 8;
}
/// A text has a zero byte at its end; an empty one is not written.
inline std::size_t textWords(std::string_view text) {
    return text.empty() ? 0 : byteWords(text.size() + 1);
}

/// The place in a message being read, and what may still be made of it.
class Reading : public Trail {
 public:
    /// `name`: in front of every sentence; may be empty. `words`: size of the message.
    Reading(std::string_view name, std::size_t words) : Trail(name), m_budget(4 * words) {}

    /// Counts what is made of the message, in words of its own layout. Lists may overlap in a
    /// hostile message and their structs may be cut short, so that few bytes become many values;
    /// this holds memory to a small multiple of the bytes received.
    void spend(std::size_t words) {
        if (words > m_budget) refuse("more values than the message has bytes for");
        m_budget -= words;
    }

    /// The number, which must be finite.
    float real(const char* field, float value) {
        if (!std::isfinite(value)) refuse(field, "not a finite number");
        return value;
    }

    /// A group or struct with x and y, or with c and s.
    template <class Pair>
    Vec2 point(const char* field, Pair pair) {
        return at(field, [&] { return Vec2{real("x", pair.getX()), real("y", pair.getY())}; });
    }
    template <class Pair>
    Rotation rotation(const char* field, Pair pair) {
        return at(field, [&] { return Rotation{real("c", pair.getC()), real("s", pair.getS())}; });
    }

    /// An enumerant, checked against the highest that is known.
    template <class Enum, class SchemaEnum>
    Enum choice(const char* field, SchemaEnum value, Enum last) {
        const auto number = static_cast<std::uint16_t>(value);
        if (number > static_cast<std::uint16_t>(last)) {
            refuse(field, "unknown value " + std::to_string(number));
        }
        return static_cast<Enum>(number);
    }

    /// Checks a list's size against `most` before anything is made of it, and pays for it.
    template <class List>
    std::size_t sizeOf(const char* field, const List& list, std::size_t most,
                       std::size_t elementBytes) {
        const std::size_t size = list.size();
        at(field, [&] {
            if (size > most) {
                refuse(std::to_string(size) + " entries, at most " + std::to_string(most));
            }
            spend(byteWords(size * elementBytes));
        });
        return size;
    }

    /// UTF-8 text without control characters, at most `most` bytes.
    std::string text(const char* field, std::string_view value, std::size_t most);

 private:
    std::size_t m_budget;
};

/// What Cap'n Proto has to say, on one line.
std::string reasonOf(const ::kj::Exception& exception);

/// Hands the root of one flat segment to `read`, with the limits that hold for every message, and
/// turns whatever is thrown within into a sentence. `bytes` need not be aligned.
template <class Schema, class T, class Read>
Result<T> readMessage(std::string_view name, std::span<const std::byte> bytes, Read&& read) {
    if (bytes.empty() || bytes.size() % 8 != 0) {
        return Error{Trail(name).sentence(std::to_string(bytes.size()) +
                                          " bytes are not a whole number of 8-byte words")};
    }
    const std::size_t words = bytes.size() / 8;
    Reading reading(name, words);
    try {
        // Cap'n Proto wants words where the machine can load them. Copying is cheaper than asking
        // every transport to align what it receives.
        std::vector<std::uint64_t> copy;
        const void* at = bytes.data();
        if (reinterpret_cast<std::uintptr_t>(at) % alignof(::capnp::word) != 0) {
            copy.resize(words);
            std::memcpy(copy.data(), at, bytes.size());
            at = copy.data();
        }
        const ::kj::ArrayPtr<const ::capnp::word> segment(static_cast<const ::capnp::word*>(at),
                                                          words);
        const ::kj::ArrayPtr<const ::capnp::word> segments[] = {segment};
        ::capnp::ReaderOptions options;
        options.traversalLimitInWords = 4 * words;
        options.nestingLimit = nestingLimit;
        ::capnp::SegmentArrayMessageReader message(segments, options);
        return T(read(reading, message.template getRoot<Schema>()));
    } catch (const Refused& refused) {
        return Error{refused.sentence};
    } catch (const ::kj::Exception& exception) {
        return Error{reading.sentence("not well-formed (" + reasonOf(exception) + ")")};
    } catch (const std::exception& exception) {
        return Error{reading.sentence("cannot be read (" + std::string(exception.what()) + ")")};
    }
}

/// Builds a message of at most `words` words (root pointer included) behind `before` bytes that are
/// left zero for a header. The result has no byte more than the message needs.
template <class Schema, class Write>
std::vector<std::byte> writeMessage(std::size_t before, std::size_t words, Write&& write) {
    static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= 8);
    std::vector<std::byte> bytes(before + 8 * words);
    // The exact builder writes into the final buffer; the usual one would copy, and would wipe our
    // buffer when it is done.
    ::capnp::FlatMessageBuilder message(::kj::ArrayPtr<::capnp::word>(
        reinterpret_cast<::capnp::word*>(bytes.data() + before), words));
    write(message.template initRoot<Schema>());
    bytes.resize(before + 8 * message.getSegmentsForOutput()[0].size());
    return bytes;
}

}  // namespace huestep::protocol::wire
