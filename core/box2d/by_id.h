/// The ids that a peer's bodies or joints have in Huestep, so that the same commands mean the same
/// there: counted up and never used again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace huestep {

/// What a peer calls a body or a joint, by ascending id.
template <class Handle>
class ById {
 public:
    struct Entry {
        std::uint32_t id = 0;
        Handle handle{};
        bool gone = false;
    };

    ById() = default;

    /// `ids[i]` is that of `handles[i]`; the next one added gets at least `next`.
    ById(const std::vector<std::uint32_t>& ids, const std::vector<Handle>& handles,
         std::uint32_t next)
        : m_next(next) {
        for (std::size_t i = 0; i < ids.size(); ++i) m_entries.push_back({ids[i], handles[i]});
        std::sort(m_entries.begin(), m_entries.end(),
                  [](const Entry& a, const Entry& b) { return a.id < b.id; });
        if (!m_entries.empty()) m_next = std::max(m_next, m_entries.back().id + 1);
    }

    std::uint32_t add(Handle handle) {
        m_entries.push_back({m_next, handle});
        return m_next++;
    }

    [[nodiscard]] std::optional<Handle> find(std::uint32_t id) {
        const Entry* entry = at(id);
        return entry == nullptr ? std::nullopt : std::optional(entry->handle);
    }

    /// Is not found any more; its place is there until `tidy`.
    void remove(std::uint32_t id) {
        Entry* entry = at(id);
        if (entry == nullptr) return;
        entry->gone = true;
        m_untidy = true;
    }

    /// Closes the places of what was removed, all in one pass.
    void tidy() {
        if (std::exchange(m_untidy, false)) {
            std::erase_if(m_entries, [](const Entry& entry) { return entry.gone; });
        }
    }

    [[nodiscard]] const std::vector<Entry>& entries() const { return m_entries; }

 private:
    Entry* at(std::uint32_t id) {
        const auto found = std::lower_bound(
            m_entries.begin(), m_entries.end(), id,
            [](const Entry& entry, std::uint32_t wanted) { return entry.id < wanted; });
        const bool there = found != m_entries.end() && found->id == id && !found->gone;
        return there ? &*found : nullptr;
    }

    std::vector<Entry> m_entries;
    std::uint32_t m_next = 1;
    bool m_untidy = false;
};

}  // namespace huestep
