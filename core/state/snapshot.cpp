#include "core/state/snapshot.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/state/hash.h"
#include "core/state/validate.h"

namespace huestep {

namespace {

constexpr char magic[8] = {'H', 'U', 'E', 'S', 'N', 'A', 'P', '1'};
// More records than any world may hold; keeps a hostile count from becoming an allocation.
constexpr std::uint64_t maxRecords = 64u << 20;

/// Writes values one after another into a buffer of the right size.
class Cursor {
 public:
    explicit Cursor(std::span<std::byte> out) : m_out(out) {}
    void put(std::span<const std::byte> bytes) {
        assert(m_at + bytes.size() <= m_out.size());
        if (!bytes.empty()) std::memcpy(m_out.data() + m_at, bytes.data(), bytes.size());
        m_at += bytes.size();
    }
    template <class T>
    void value(const T& v) {
        put(std::as_bytes(std::span(&v, 1)));
    }

 private:
    std::span<std::byte> m_out;
    std::size_t m_at = 0;
};

template <class T>
T get(std::span<const std::byte> bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

std::string number(std::uint64_t n) {
    return std::to_string(n);
}

/// The arrays that a snapshot of this version holds.
template <class State, class Visit>
void forEachArrayIn(std::uint32_t version, State& state, Visit&& visit) {
    forEachArray(state, [&](std::string_view name, auto& array) {
        using Record = std::remove_cvref_t<decltype(array[0])>;
        if (!isOfRules<Record> || version == rulesSnapshotVersion) visit(name, array);
    });
}

std::size_t pieces(std::size_t bytes) {
    return (bytes + snapshotPiece - 1) / snapshotPiece;
}

/// The checksums at the end of an image agree with what is above them.
Status checkPieces(std::span<const std::byte> bytes, std::size_t contentBytes) {
    const std::size_t count = pieces(contentBytes);
    const auto sums = bytes.subspan(contentBytes, count * 8);
    if (get<std::uint64_t>(bytes, contentBytes + count * 8) != hash64(sums)) {
        return Error{"snapshot: the checksums at offset " + number(contentBytes) +
                     " do not match their own checksum"};
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = i * snapshotPiece;
        const std::size_t size = std::min(snapshotPiece, contentBytes - from);
        if (hash64(bytes.subspan(from, size)) != get<std::uint64_t>(sums, i * 8)) {
            return Error{"snapshot: bytes " + number(from) + " to " + number(from + size - 1) +
                         " do not match their checksum"};
        }
    }
    return Done{};
}

/// The version, if this program reads it and the header is whole.
Result<std::uint32_t> readHead(std::span<const std::byte> bytes) {
    constexpr std::size_t headBytes = 16;
    if (bytes.size() < headBytes) {
        return Error{"snapshot: " + number(bytes.size()) + " bytes are too few for its header of " +
                     number(headBytes)};
    }
    if (std::memcmp(bytes.data(), magic, sizeof magic) != 0) {
        return Error{"snapshot: offset 0 does not hold the mark \"HUESNAP1\""};
    }
    const auto version = get<std::uint32_t>(bytes, 8);
    if (version != snapshotVersion && version != rulesSnapshotVersion) {
        return Error{"snapshot: offset 8 says version " + number(version) +
                     "; this program reads versions " + number(snapshotVersion) + " and " +
                     number(rulesSnapshotVersion)};
    }
    std::uint32_t arrays = 0;
    const WorldState state;
    forEachArrayIn(version, state, [&](std::string_view, const auto&) { ++arrays; });
    if (const auto count = get<std::uint32_t>(bytes, 12); count != arrays) {
        return Error{"snapshot: offset 8 says version " + number(version) + ", offset 12 says " +
                     number(count) + " arrays instead of its " + number(arrays)};
    }
    if (const std::size_t tableEnd = headBytes + arrays * std::size_t{8}; bytes.size() < tableEnd) {
        return Error{"snapshot: " + number(bytes.size()) + " bytes are too few for its table of " +
                     number(tableEnd)};
    }
    return version;
}

}  // namespace

std::vector<std::byte> writeSnapshot(const WorldState& state) {
    const std::uint32_t version = state.rules.empty() ? snapshotVersion : rulesSnapshotVersion;
    std::uint32_t arrays = 0;
    std::size_t size = 16;
    forEachArrayIn(version, state, [&](std::string_view, const auto& array) {
        ++arrays;
        size += 8 + array.size() * sizeof(array[0]);
    });
    std::vector<std::byte> out(size + pieces(size) * 8 + 8);
    Cursor cursor(out);
    cursor.value(magic);
    cursor.value(version);
    cursor.value(arrays);
    forEachArrayIn(version, state, [&](std::string_view, const auto& array) {
        cursor.value(static_cast<std::uint32_t>(sizeof(array[0])));
        cursor.value(static_cast<std::uint32_t>(array.size()));
    });
    forEachArrayIn(version, state, [&](std::string_view, const auto& array) {
        cursor.put(std::as_bytes(std::span(array)));
    });
    std::vector<std::uint64_t> sums;
    for (std::size_t from = 0; from < size; from += snapshotPiece) {
        sums.push_back(hash64(std::span(out).subspan(from, std::min(snapshotPiece, size - from))));
    }
    cursor.put(std::as_bytes(std::span(sums)));
    cursor.value(hash64(std::as_bytes(std::span(sums))));
    return out;
}

Result<WorldState> readSnapshot(std::span<const std::byte> bytes) {
    const Result<std::uint32_t> version = readHead(bytes);
    if (!version) return version.error();
    const std::size_t tableEnd = 16 + std::size_t{8} * get<std::uint32_t>(bytes, 12);
    WorldState state;
    std::size_t entry = 16;
    std::size_t end = tableEnd;
    std::string problem;
    forEachArrayIn(*version, state, [&](std::string_view name, const auto& array) {
        const auto recordBytes = get<std::uint32_t>(bytes, entry);
        const auto records = get<std::uint32_t>(bytes, entry + 4);
        if (problem.empty() && (recordBytes != sizeof(array[0]) || records > maxRecords)) {
            problem = "snapshot: offset " + number(entry) + " says " + number(records) +
                      " records of " + number(recordBytes) + " bytes for \"" + std::string(name) +
                      "\"; a record has " + number(sizeof(array[0]));
        }
        end += std::size_t{recordBytes} * records;
        entry += 8;
    });
    if (!problem.empty()) return Error{problem};
    if (bytes.size() != end + pieces(end) * 8 + 8) {
        return Error{"snapshot: the table at offset 16 asks for " +
                     number(end + pieces(end) * 8 + 8) + " bytes; there are " +
                     number(bytes.size())};
    }
    if (const Status intact = checkPieces(bytes, end); !intact) return intact.error();

    entry = 16;
    std::size_t from = tableEnd;
    forEachArrayIn(*version, state, [&](std::string_view, auto& array) {
        array.resize(get<std::uint32_t>(bytes, entry + 4));
        const std::size_t size = array.size() * sizeof(array[0]);
        if (size > 0) std::memcpy(array.data(), bytes.data() + from, size);
        from += size;
        entry += 8;
    });
    if (*version == rulesSnapshotVersion && state.rules.empty()) {
        return Error{"snapshot: offset 8 says version " + number(*version) +
                     ", that of worlds with rules, and there are none"};
    }
    if (const Status valid = validate(state); !valid) {
        return Error{"snapshot: " + valid.error().message};
    }
    return state;
}

}  // namespace huestep
