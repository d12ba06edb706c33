/// Whole files, in and out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace huestep::tools {

/// All bytes of a regular file of at most `limit` bytes. The sentence names the file.
Result<std::vector<std::byte>> readFile(const std::string& path, std::size_t limit);

/// A file for what long work brings. It is opened before the work, so that a wrong path costs none;
/// what it holds stays until `write`, and a new one is gone again if nothing is written.
class OutputFile {
 public:
    /// Without a path there is no file, and `write` does nothing. The sentence names the file.
    static Result<OutputFile> open(const std::string& path);
    ~OutputFile();
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    [[nodiscard]] bool named() const { return !m_path.empty(); }
    /// Puts the bytes in the place of what the file held. The sentence names the file.
    Status write(std::span<const std::byte> bytes);

 private:
    OutputFile(std::string path, bool made) : m_path(std::move(path)), m_made(made) {}
    std::string m_path;
    bool m_made;  ///< by `open`, and still empty
};

}  // namespace huestep::tools
