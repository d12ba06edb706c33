/// Where in a document a reader is, and how it refuses what it finds there.
///
/// The readers of Cap'n Proto messages and of JSON documents go field by field and have a hundred
/// places at which something may be wrong. Inside them a refusal is an exception, caught by the one
/// function that starts the reading and never let out of this folder: that keeps a branch after
/// every line out of the code, and the path is put into words only where it is needed.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace huestep::protocol {

/// Thrown by `Trail::refuse` and caught where the reading started.
struct Refused {
    std::string sentence;
};

/// The path from the document's root to the field being read.
class Trail {
 public:
    /// `root`: in front of every path, such as a message's name; may be empty.
    explicit Trail(std::string_view root) : m_root(root) {}

    /// Does `f` inside a field, or inside an entry of a list. The step is left on a normal return
    /// only, so that after an exception `where` still tells how far the reading had come.
    template <class F>
    decltype(auto) at(std::string_view field, F&& f) {
        return at(field, noIndex, std::forward<F>(f));
    }
    template <class F>
    decltype(auto) at(std::string_view field, std::size_t index, F&& f) {
        if (m_depth < m_steps.size()) m_steps[m_depth] = {field, index};
        ++m_depth;
        if constexpr (std::is_void_v<decltype(f())>) {
            f();
            --m_depth;
        } else {
            auto result = f();
            --m_depth;
            return result;
        }
    }

    /// Does `f` inside an entry of the list whose field we are at.
    template <class F>
    void atIndex(std::size_t index, F&& f) {
        const std::size_t step = m_depth - 1;
        if (step < m_steps.size()) m_steps[step].index = index;
        f();
        if (step < m_steps.size()) m_steps[step].index = noIndex;
    }

    /// "Frame.commands[3].action"
    [[nodiscard]] std::string where() const;
    /// The path, a colon and the reason; the reason alone at a root without a name.
    [[nodiscard]] std::string sentence(const std::string& reason) const;
    [[noreturn]] void refuse(const std::string& reason) const { throw Refused{sentence(reason)}; }
    /// Refuses a field of the place we are at.
    [[noreturn]] void refuse(std::string_view field, const std::string& reason) {
        if (m_depth < m_steps.size()) m_steps[m_depth] = {field, noIndex};
        ++m_depth;
        refuse(reason);
    }

 private:
    struct Step {
        std::string_view field;
        std::size_t index = 0;
    };
    static constexpr std::size_t noIndex = ~std::size_t{0};

    std::string_view m_root;
    std::array<Step, 24> m_steps{};
    std::size_t m_depth = 0;
};

}  // namespace huestep::protocol
