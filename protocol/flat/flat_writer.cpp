#include "protocol/flat/flat_writer.h"

namespace huestep::protocol::flat {

namespace {

std::uint32_t highOf(Layout layout) {
    return layout.dataWords | std::uint32_t{layout.pointers} << 16;
}

}  // namespace

std::size_t FlatWriter::add(std::size_t pointer, std::size_t words, unsigned kind,
                            std::uint32_t high) {
    const std::size_t at = m_bytes.size();
    m_bytes.resize(at + 8 * words);
    const auto offset = static_cast<std::uint32_t>((at - pointer) / 8 - 1);
    store(m_bytes, pointer, offset << 2 | kind);
    store(m_bytes, pointer + 4, high);
    return at;
}

std::size_t FlatWriter::addStruct(std::size_t pointer, Layout layout) {
    return add(pointer, layout.words(), 0, highOf(layout));
}

std::size_t FlatWriter::addList(std::size_t pointer, unsigned code, std::size_t count,
                                std::size_t bytes) {
    const auto high = static_cast<std::uint32_t>(count << 3 | code);
    return add(m_pointers + 8 * pointer, (bytes + 7) / 8, 1, high);
}

std::size_t FlatWriter::addComposite(std::size_t pointer, Layout layout, std::size_t count) {
    const std::size_t words = count * layout.words();
    const std::size_t at =
        add(m_pointers + 8 * pointer, words + 1, 1, static_cast<std::uint32_t>(words << 3 | 7));
    store(m_bytes, at, static_cast<std::uint32_t>(count << 2));
    store(m_bytes, at + 4, highOf(layout));
    return at + 8;
}

}  // namespace huestep::protocol::flat
