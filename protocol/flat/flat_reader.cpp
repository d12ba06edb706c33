#include "protocol/flat/flat_reader.h"

#include "protocol/plain_text.h"

namespace huestep::protocol::flat {

FlatReader::FlatReader(std::string_view name, std::span<const std::byte> segment)
    : m_name(name),
      m_segment(segment),
      m_mayVisit(4 * (segment.size() / 8)),
      m_mayMake(4 * (segment.size() / 8)) {
    check("", !segment.empty() && segment.size() % 8 == 0, "not a whole number of 8-byte words");
}

void FlatReader::check(const char* field, bool holds, std::string_view otherwise) {
    if (holds || m_error) return;
    std::string where(m_name);
    const auto add = [&where](std::string_view name, std::size_t index) {
        if (name.empty()) return;
        where += '.';
        where += name;
        if (index != noIndex) where += "[" + std::to_string(index) + "]";
    };
    for (std::size_t i = 0; i < m_depth && i < m_path.size(); ++i) {
        add(m_path[i].field, m_path[i].index);
    }
    add(field, noIndex);
    m_error = Error{where + ": " + std::string(otherwise)};
}

void FlatReader::flag(std::size_t bit, bool& value, bool standard) {
    bool stored = false;
    if (bit / 8 < m_now.dataBytes) {
        const auto byte = load<std::uint8_t>(m_segment, m_now.data + bit / 8);
        stored = (byte >> (bit % 8) & 1) != 0;
    }
    value = stored != standard;
}

void FlatReader::text(const char* field, std::size_t pointer, std::string& value,
                      std::size_t most) {
    value.clear();
    const List list = listAt(field, pointer, codeOf(1));
    if (m_error || list.at == 0) return;
    const auto* const from = reinterpret_cast<const char*>(m_segment.data() + list.at);
    const bool ended = list.count > 0 && from[list.count - 1] == '\0';
    check(field, ended, "a text without its end");
    if (m_error) return;
    const std::string_view found(from, list.count - 1);
    check(field, found.size() <= most, "longer than " + std::to_string(most) + " bytes");
    check(field, isPlainText(found), "not UTF-8 text without control characters");
    if (!m_error) value = found;
}

bool FlatReader::visit(const char* field, std::int64_t at, std::size_t words) {
    const auto size = static_cast<std::int64_t>(m_segment.size());
    const bool inside = at >= 0 && at <= size && words <= static_cast<std::uint64_t>(size - at) / 8;
    check(field, inside, "a pointer that leads out of the message");
    check(field, words <= m_mayVisit, "more values than the message has bytes for");
    if (m_error) return false;
    m_mayVisit -= words;
    return true;
}

namespace {

/// Where a pointer leads, in bytes from the segment's start: words from its own end.
std::int64_t targetOf(std::size_t pointer, std::uint32_t low) {
    const auto words = static_cast<std::int32_t>(low) >> 2;
    return static_cast<std::int64_t>(pointer) + 8 + 8 * std::int64_t{words};
}

Layout layoutOf(std::uint32_t high) {
    return {static_cast<std::uint16_t>(high & 0xffffu), static_cast<std::uint16_t>(high >> 16)};
}

}  // namespace

FlatReader::Struct FlatReader::structAt(const char* field, std::size_t pointer) {
    if (m_error) return {};
    const auto low = load<std::uint32_t>(m_segment, pointer);
    const auto high = load<std::uint32_t>(m_segment, pointer + 4);
    if (low == 0 && high == 0) return {};
    check(field, (low & 3) == 0, "not a struct of this segment");
    const Layout layout = layoutOf(high);
    const std::int64_t at = targetOf(pointer, low);
    if (m_error || !visit(field, at, layout.words())) return {};
    return {static_cast<std::size_t>(at), 8u * layout.dataWords, layout.pointers};
}

FlatReader::List FlatReader::listAt(const char* field, std::size_t index, unsigned code) {
    if (m_error || index >= m_now.pointers) return {};
    const std::size_t pointer = pointerAt(index);
    const auto low = load<std::uint32_t>(m_segment, pointer);
    const auto high = load<std::uint32_t>(m_segment, pointer + 4);
    if (low == 0 && high == 0) return {};
    check(field, (low & 3) == 1 && (high & 7) == code, "not a list of its kind");
    const std::int64_t at = targetOf(pointer, low);
    const std::size_t count = high >> 3;
    if (code == composite) {
        if (m_error || !visit(field, at, count + 1)) return {};
        return compositeAt(field, static_cast<std::size_t>(at), count);
    }
    constexpr std::array<std::size_t, 6> bytes = {0, 0, 1, 2, 4, 8};
    if (m_error || !visit(field, at, (count * bytes[code] + 7) / 8)) return {};
    return {static_cast<std::size_t>(at), count, {}};
}

/// A tag in front of the elements has their number and layout.
FlatReader::List FlatReader::compositeAt(const char* field, std::size_t at, std::size_t words) {
    const auto low = load<std::uint32_t>(m_segment, at);
    const Layout layout = layoutOf(load<std::uint32_t>(m_segment, at + 4));
    const std::size_t count = low >> 2;
    check(field, (low & 3) == 0, "a list of structs that says it has none");
    check(field, std::uint64_t{count} * layout.words() <= words, "more entries than it has words");
    if (layout.words() == 0 && !visit(field, static_cast<std::int64_t>(at), 0)) return {};
    check(field, layout.words() != 0 || count <= m_mayVisit, "more entries than the message has");
    if (m_error) return {};
    if (layout.words() == 0) m_mayVisit -= count;
    return {at + 8, count, layout};
}

std::size_t FlatReader::countOf(const char* field, const List& list, std::size_t most,
                                std::size_t bytes) {
    if (m_error) return 0;
    const std::size_t words = (list.count * bytes + 7) / 8;
    check(field, list.count <= most,
          std::to_string(list.count) + " entries, at most " + std::to_string(most));
    check(field, words <= m_mayMake, "more values than the message has bytes for");
    if (m_error) return 0;
    m_mayMake -= words;
    return list.count;
}

}  // namespace huestep::protocol::flat
