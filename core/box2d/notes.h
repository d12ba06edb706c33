/// What a conversion loses: one sentence a kind of loss, with the first place and a count.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace huestep {

/// "bodies[3]"
inline std::string pathOf(std::string_view list, std::size_t index) {
    return std::string(list) + '[' + std::to_string(index) + ']';
}

class Notes {
 public:
    /// `loss` is a kind of loss, told as a sentence about the thing at `path`.
    void add(const std::string& path, std::string_view loss) {
        for (Entry& entry : m_entries) {
            if (entry.loss == loss) {
                ++entry.more;
                return;
            }
        }
        m_entries.push_back({path, std::string(loss), 0});
    }

    /// "bodies[3].shapes[0] and 41 more: its rounded corners are made sharp"
    [[nodiscard]] std::vector<std::string> sentences() const {
        std::vector<std::string> result;
        for (const Entry& entry : m_entries) {
            std::string sentence = entry.first;
            if (entry.more > 0) sentence += " and " + std::to_string(entry.more) + " more";
            result.push_back(sentence + ": " + entry.loss);
        }
        return result;
    }

 private:
    struct Entry {
        std::string first;
        std::string loss;
        std::size_t more = 0;
    };
    std::vector<Entry> m_entries;
};

}  // namespace huestep
