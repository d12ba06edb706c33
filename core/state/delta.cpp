#include "core/state/delta.h"

#include <algorithm>
#include <cstring>

#include "core/state/hash.h"
#include "core/state/roots.h"
#include "core/state/validate.h"

namespace huestep {

namespace {

constexpr char magic[8] = {'H', 'U', 'E', 'D', 'E', 'L', 'T', '1'};
constexpr std::size_t headBytes = 32;
constexpr std::size_t sumBytes = 8;

enum Kind : std::uint32_t { Same = 0, Changed = 1, New = 2, Gone = 3 };

/// By what a record of an array is known in both states: rises along the array.
template <class Record>
std::uint64_t keyOf(const WorldState& s, const std::vector<Record>& array, std::size_t i) {
    if constexpr (std::is_same_v<Record, ContactState>) {
        return (std::uint64_t{array[i].shapeA} << 32) | array[i].shapeB;
    } else if constexpr (std::is_same_v<Record, BodyMotion>) {
        return &array == &s.motions ? s.bodies[i].id : i;
    } else if constexpr (std::is_same_v<Record, JointImpulses>) {
        return s.joints[i].id;
    } else if constexpr (requires { array[i].id; }) {
        // What players get has no ids.
        const void* const here = &array;
        return here == &s.playerBody || here == &s.playerShapes ? i : array[i].id;
    } else {
        return i;
    }
}

template <class Record>
std::span<const std::byte, sizeof(Record)> bytesOf(const Record& record) {
    return std::as_bytes(std::span<const Record, 1>(&record, 1));
}

class Writer {
 public:
    void put(std::span<const std::byte> bytes) {
        m_out.insert(m_out.end(), bytes.begin(), bytes.end());
    }
    template <class T>
    void value(const T& v) {
        put(bytesOf(v));
    }
    /// One more record of a kind; records of one kind in a row share a run.
    void count(Kind kind) {
        if (m_runs == 0 || m_kind != kind) {
            m_run = m_out.size();
            m_kind = kind;
            value(std::uint32_t{kind});
            m_runs = 1;
        }
        std::uint32_t run;
        std::memcpy(&run, &m_out[m_run], sizeof run);
        run += 4;
        std::memcpy(&m_out[m_run], &run, sizeof run);
    }
    void endArray() { m_runs = 0; }
    template <class Record>
    void changes(const Record& from, const Record& to) {
        const auto before = bytesOf(from);
        const auto after = bytesOf(to);
        const std::size_t mask = m_out.size();
        m_out.resize(mask + (sizeof(Record) + 7) / 8, std::byte{0});
        for (std::size_t i = 0; i < sizeof(Record); ++i) {
            if (before[i] == after[i]) continue;
            m_out[mask + i / 8] |= std::byte{1} << (i % 8);
            m_out.push_back(after[i]);
        }
    }
    std::vector<std::byte> sealed() {
        value(hash64(m_out));
        return std::move(m_out);
    }

 private:
    std::vector<std::byte> m_out;
    std::size_t m_run = 0;  // where the open run's head is
    std::uint32_t m_runs = 0;
    Kind m_kind = Same;
};

template <class Record>
void writeArray(Writer& out, const WorldState& baseState, const std::vector<Record>& base,
                const WorldState& state, const std::vector<Record>& array) {
    out.value(static_cast<std::uint32_t>(array.size()));
    std::size_t from = 0;
    for (std::size_t i = 0; i < array.size(); ++i) {
        const std::uint64_t key = keyOf(state, array, i);
        for (; from < base.size() && keyOf(baseState, base, from) < key; ++from) out.count(Gone);
        if (from == base.size() || keyOf(baseState, base, from) != key) {
            out.count(New);
            out.value(array[i]);
        } else if (std::memcmp(&base[from], &array[i], sizeof(Record)) == 0) {
            out.count(Same);
            ++from;
        } else {
            out.count(Changed);
            out.changes(base[from], array[i]);
            ++from;
        }
    }
    for (; from < base.size(); ++from) out.count(Gone);
    out.endArray();
}

std::string number(std::uint64_t n) {
    return std::to_string(n);
}

/// Reads values one after another; once something is wrong it stays wrong and says what was first.
class Reader {
 public:
    Reader(std::span<const std::byte> bytes, std::size_t at) : m_bytes(bytes), m_at(at) {}

    [[nodiscard]] const std::string& problem() const { return m_problem; }
    [[nodiscard]] bool atEnd() const { return m_at == m_bytes.size(); }
    [[nodiscard]] std::size_t at() const { return m_at; }

    bool fail(const std::string& what) {
        if (m_problem.empty()) m_problem = "delta: offset " + number(m_at) + " " + what;
        return false;
    }
    bool take(std::span<std::byte> to) {
        if (m_bytes.size() - m_at < to.size()) return fail("is the end where more is announced");
        if (!to.empty()) std::memcpy(to.data(), m_bytes.data() + m_at, to.size());
        m_at += to.size();
        return true;
    }
    template <class T>
    bool value(T& to) {
        return take(std::as_writable_bytes(std::span(&to, 1)));
    }
    template <class Record>
    bool changes(Record& record) {
        std::array<std::byte, (sizeof(Record) + 7) / 8> mask{};
        if (!take(mask)) return false;
        const auto bytes = std::as_writable_bytes(std::span(&record, 1));
        for (std::size_t i = 0; i < sizeof(Record); ++i) {
            if ((mask[i / 8] & (std::byte{1} << (i % 8))) == std::byte{0}) continue;
            if (!take(bytes.subspan(i, 1))) return false;
        }
        return true;
    }

 private:
    std::span<const std::byte> m_bytes;
    std::size_t m_at;
    std::string m_problem;
};

template <class Record>
bool readArray(Reader& in, std::string_view name, const std::vector<Record>& base,
               std::vector<Record>& array) {
    const auto of = [&](const char* what) {
        return std::string(what) + " of array \"" + std::string(name) + "\"";
    };
    std::uint32_t records = 0;
    if (!in.value(records)) return false;
    array.clear();  // grows with what the bytes and the base hold, whatever the count says
    std::size_t from = 0;
    while (array.size() < records || from < base.size()) {
        std::uint32_t run = 0;
        if (!in.value(run)) return false;
        const std::uint32_t kind = run & 3u;
        const std::uint32_t count = run >> 2;
        if (count == 0) return in.fail("follows an empty run" + of(""));
        if (kind != New && count > base.size() - from) {
            return in.fail("follows a run past the base's records" + of(""));
        }
        if (kind != Gone && count > records - array.size()) {
            return in.fail("follows a run past the announced records" + of(""));
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            Record record{};
            if (kind == New && !in.value(record)) return false;
            if (kind != New) record = base[from++];
            if (kind == Changed && !in.changes(record)) return false;
            if (kind != Gone) array.push_back(record);
        }
    }
    return true;
}

template <class T>
T get(std::span<const std::byte> bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// The arrays that a delta of this version goes over, of one state or two.
template <class Visit, class... States>
void forEachArrayIn(std::uint32_t version, Visit&& visit, States&... states) {
    forEachArrayOf(
        [&](std::string_view name, auto& first, auto&... others) {
            using Record = std::remove_cvref_t<decltype(first[0])>;
            if (!isOfRules<Record> || version == rulesDeltaVersion) visit(name, first, others...);
        },
        states...);
}

std::uint32_t arrayCount(std::uint32_t version) {
    const WorldState state;
    std::uint32_t arrays = 0;
    forEachArrayIn(
        version, [&](std::string_view, const auto&) { ++arrays; }, state);
    return arrays;
}

Status checkHead(std::uint64_t baseRoot, std::span<const std::byte> bytes) {
    if (bytes.size() < headBytes + sumBytes) {
        return Error{"delta: " + number(bytes.size()) + " bytes are too few for its header of " +
                     number(headBytes) + " and its checksum"};
    }
    if (std::memcmp(bytes.data(), magic, sizeof magic) != 0) {
        return Error{"delta: offset 0 does not hold the mark \"HUEDELT1\""};
    }
    const auto version = get<std::uint32_t>(bytes, 8);
    if (version != deltaVersion && version != rulesDeltaVersion) {
        return Error{"delta: offset 8 says version " + number(version) +
                     "; this program reads versions " + number(deltaVersion) + " and " +
                     number(rulesDeltaVersion)};
    }
    const std::size_t end = bytes.size() - sumBytes;
    if (get<std::uint64_t>(bytes, end) != hash64(bytes.first(end))) {
        return Error{"delta: the checksum at offset " + number(end) +
                     " is not that of the bytes before it"};
    }
    if (const auto arrays = get<std::uint32_t>(bytes, 12); arrays != arrayCount(version)) {
        return Error{"delta: offset 12 says " + number(arrays) + " arrays instead of " +
                     number(arrayCount(version))};
    }
    if (get<std::uint64_t>(bytes, 16) != baseRoot) {
        return Error{
            "delta: offset 16 names another base: restore it from the state that it was "
            "made against"};
    }
    return Done{};
}

}  // namespace

std::vector<std::byte> writeDelta(const WorldState& base, std::uint64_t baseRoot,
                                  const WorldState& state, std::uint64_t root) {
    const bool rules = !base.rules.empty() || !state.rules.empty();
    const std::uint32_t version = rules ? rulesDeltaVersion : deltaVersion;
    Writer out;
    out.value(magic);
    out.value(version);
    out.value(arrayCount(version));
    out.value(baseRoot);
    out.value(root);
    forEachArrayIn(
        version,
        [&](std::string_view, const auto& from, const auto& to) {
            writeArray(out, base, from, state, to);
        },
        base, state);
    return out.sealed();
}

Result<WorldState> readDelta(const WorldState& base, std::uint64_t baseRoot,
                             std::span<const std::byte> bytes) {
    if (const Status fine = checkHead(baseRoot, bytes); !fine) return fine.error();
    WorldState state;
    Reader in(bytes.first(bytes.size() - sumBytes), headBytes);
    forEachArrayIn(
        get<std::uint32_t>(bytes, 8),
        [&](std::string_view name, const auto& from, auto& to) {
            if (in.problem().empty()) readArray(in, name, from, to);
        },
        base, state);
    if (in.problem().empty() && !in.atEnd()) in.fail("is where the last array ends, not the bytes");
    if (!in.problem().empty()) return Error{in.problem()};
    if (const Status valid = validate(state); !valid) {
        return Error{"delta: " + valid.error().message};
    }
    RootCache cache;
    if (fullRoot(state, cache) != get<std::uint64_t>(bytes, 24)) {
        return Error{"delta: offset 24 holds another root than what its runs come to"};
    }
    return state;
}

}  // namespace huestep
