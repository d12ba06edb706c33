#include "tools/files.h"

#include <filesystem>
#include <fstream>

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

Status writeFile(const std::string& path, std::span<const std::byte> bytes) {
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) return Error{path + ": cannot be written"};
    return Done{};
}

}  // namespace huestep::tools
