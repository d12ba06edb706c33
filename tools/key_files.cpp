#include "tools/key_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/files.h"

namespace huestep::tools {

Result<protocol::Keys> readKeyFile(const std::string& path) {
    const Result<std::vector<std::byte>> bytes = readFile(path, protocol::maxKeyFileBytes);
    if (!bytes) return bytes.error();
    Result<protocol::Keys> keys =
        protocol::parseKeys({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    if (!keys) return Error{path + ": " + keys.error().message};
    struct stat about {};
    if (stat(path.c_str(), &about) != 0) return Error{path + ": " + std::strerror(errno)};
    if (keys->secret() && (about.st_mode & (S_IRWXG | S_IRWXO)) != 0)
        return Error{path + ": others may read this secret key; take it from them with chmod 600 " +
                     path};
    return keys;
}

Status writeKeyFile(const std::string& path, const protocol::Keys& keys) {
    const mode_t mode = keys.secret() ? 0600 : 0644;
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file < 0 && errno == EEXIST)
        return Error{path + ": is there already; a key is not overwritten"};
    if (file < 0) return Error{path + ": " + std::strerror(errno)};
    const std::string text = protocol::toText(keys);
    const bool written =
        ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    const bool kept = ::fsync(file) == 0;
    if (::close(file) != 0 || !written || !kept) {
        ::unlink(path.c_str());
        return Error{path + ": cannot be written"};
    }
    return Done{};
}

}  // namespace huestep::tools
