#include "tools/files.h"

#include <filesystem>
#include <fstream>
#include <utility>

namespace huestep::tools {

Result<std::vector<std::byte>> readFile(const std::string& path, std::size_t limit) {
    std::error_code wrong;
    if (!std::filesystem::exists(path, wrong)) return Error{path + ": there is no such file"};
    if (!std::filesystem::is_regular_file(path, wrong)) return Error{path + ": not a file"};
    const std::uintmax_t size = std::filesystem::file_size(path, wrong);
    if (wrong) return Error{path + ": " + wrong.message()};
    if (size > limit)
        return Error{path + ": " + std::to_string(size) + " bytes are more than the " +
                     std::to_string(limit) + " allowed"};
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::ifstream in(path, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!in) return Error{path + ": cannot be read"};
    return bytes;
}

Result<OutputFile> OutputFile::open(const std::string& path) {
    if (path.empty()) return OutputFile("", false);
    std::error_code wrong;
    const bool made = !std::filesystem::exists(path, wrong);
    const std::ofstream probe(path, std::ios::binary | std::ios::app);
    if (!probe) return Error{path + ": cannot be written"};
    return OutputFile(path, made);
}

OutputFile::~OutputFile() {
    std::error_code ignored;
    if (m_made) std::filesystem::remove(m_path, ignored);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : m_path(std::move(other.m_path)), m_made(std::exchange(other.m_made, false)) {}

Status OutputFile::write(std::span<const std::byte> bytes) {
    if (!named()) return Done{};
    m_made = false;
    std::ofstream out(m_path, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) return Error{m_path + ": cannot be written"};
    return Done{};
}

}  // namespace huestep::tools
