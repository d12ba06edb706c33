#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "protocol/log_store.h"

namespace huestep::protocol {

namespace {

constexpr std::string_view temporarySuffix = ".tmp";

/// A file descriptor with one owner.
class Descriptor {
 public:
    explicit Descriptor(int number = -1) : m_number(number) {}
    Descriptor(Descriptor&& other) noexcept : m_number(std::exchange(other.m_number, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(m_number, other.m_number);
        return *this;
    }
    ~Descriptor() {
        if (m_number >= 0) ::close(m_number);
    }
    [[nodiscard]] int number() const { return m_number; }
    [[nodiscard]] bool open() const { return m_number >= 0; }

 private:
    int m_number;
};

/// Files are opened relative to the folder, never through a path made of a name, and symbolic
/// links are not followed: a name can reach nothing outside.
class FolderStore final : public LogStore {
 public:
    FolderStore(std::string path, Descriptor folder)
        : m_path(std::move(path)), m_folder(std::move(folder)) {}

    Result<std::vector<std::string>> list() override;
    Result<std::vector<std::string>> everyFile();
    Result<std::vector<std::byte>> read(const std::string& name) override;
    Status append(const std::string& name, std::span<const std::byte> bytes) override;
    Status sync(const std::string& name) override;
    Status truncate(const std::string& name, std::uint64_t size) override;
    Status replace(const std::string& name, std::span<const std::byte> bytes) override;
    Status remove(const std::string& name) override;
    std::string describe(const std::string& name) const override { return m_path + "/" + name; }
    Status lockForWriting() override;

 private:
    [[nodiscard]] Error failed(const std::string& name, const char* what) const;
    Result<Descriptor> openFile(const std::string& name, int flags) const;
    Status writeAll(const Descriptor& file, const std::string& name,
                    std::span<const std::byte> bytes) const;
    Status writeTemporary(const std::string& temporary, std::span<const std::byte> bytes) const;
    Status syncFolder(const std::string& name) const;
    Status openForAppending(const std::string& name);
    Status removeTemporaries();

    std::string m_path;
    Descriptor m_folder;
    // The file appended to last stays open: an error of writing back is reported to descriptors
    // that were open when it happened, so a fresh one might sync without learning of it.
    Descriptor m_appended;
    std::string m_appendedName;
};

Error FolderStore::failed(const std::string& name, const char* what) const {
    const int number = errno;
    const std::string path = name.empty() ? m_path : describe(name);
    return Error{path + ": cannot " + what + ": " + std::generic_category().message(number)};
}

Result<Descriptor> FolderStore::openFile(const std::string& name, int flags) const {
    if (!isPlainFileName(name)) return Error{"'" + name + "' is not a plain file name"};
    Descriptor file(::openat(m_folder.number(), name.c_str(), flags | O_CLOEXEC | O_NOFOLLOW,
                             S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH));
    if (!file.open()) return failed(name, "open");
    return file;
}

Status FolderStore::writeAll(const Descriptor& file, const std::string& name,
                             std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return failed(name, "write");
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return Done{};
}

Status FolderStore::syncFolder(const std::string& name) const {
    if (::fsync(m_folder.number()) != 0) return failed(name, "sync the folder of");
    return Done{};
}

Result<std::vector<std::string>> FolderStore::list() {
    Result<std::vector<std::string>> names = everyFile();
    if (names) {
        std::erase_if(*names, [](const auto& name) { return name.ends_with(temporarySuffix); });
    }
    return names;
}

Result<std::vector<std::string>> FolderStore::everyFile() {
    const int copy = ::openat(m_folder.number(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR* folder = copy < 0 ? nullptr : ::fdopendir(copy);
    if (folder == nullptr) {
        const Error error = failed("", "list");
        if (copy >= 0) ::close(copy);
        return error;
    }
    std::vector<std::string> names;
    errno = 0;
    while (const dirent* entry = ::readdir(folder)) {
        const std::string name = static_cast<const char*>(entry->d_name);
        struct stat info {};
        const bool regular =
            ::fstatat(m_folder.number(), name.c_str(), &info, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISREG(info.st_mode);
        if (regular && isPlainFileName(name)) names.push_back(name);
        errno = 0;
    }
    const bool complete = errno == 0;
    const Error error = complete ? Error{} : failed("", "list");
    ::closedir(folder);
    if (!complete) return error;
    std::sort(names.begin(), names.end());
    return names;
}

Result<std::vector<std::byte>> FolderStore::read(const std::string& name) {
    const Result<Descriptor> file = openFile(name, O_RDONLY);
    if (!file) return file.error();
    struct stat info {};
    if (::fstat(file->number(), &info) != 0 || !S_ISREG(info.st_mode)) {
        return failed(name, "look at");
    }
    std::vector<std::byte> bytes(static_cast<std::size_t>(info.st_size));
    std::size_t at = 0;
    while (at < bytes.size()) {
        const ssize_t got = ::read(file->number(), bytes.data() + at, bytes.size() - at);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return failed(name, "read");
        if (got == 0) break;
        at += static_cast<std::size_t>(got);
    }
    bytes.resize(at);
    return bytes;
}

Status FolderStore::openForAppending(const std::string& name) {
    if (m_appended.open() && m_appendedName == name) return Done{};
    Result<Descriptor> file = openFile(name, O_WRONLY | O_APPEND);
    if (!file) return file.error();
    m_appended = std::move(file).value();
    m_appendedName = name;
    return Done{};
}

Status FolderStore::append(const std::string& name, std::span<const std::byte> bytes) {
    if (Status opened = openForAppending(name); !opened) return opened;
    return writeAll(m_appended, name, bytes);
}

Status FolderStore::sync(const std::string& name) {
    if (Status opened = openForAppending(name); !opened) return opened;
    if (::fdatasync(m_appended.number()) != 0) return failed(name, "sync");
    return Done{};
}

Status FolderStore::truncate(const std::string& name, std::uint64_t size) {
    if (Status opened = openForAppending(name); !opened) return opened;
    if (::ftruncate(m_appended.number(), static_cast<off_t>(size)) != 0) {
        return failed(name, "shorten");
    }
    return Done{};
}

Status FolderStore::writeTemporary(const std::string& temporary,
                                   std::span<const std::byte> bytes) const {
    const Result<Descriptor> file = openFile(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file) return file.error();
    if (Status written = writeAll(*file, temporary, bytes); !written) return written;
    if (::fsync(file->number()) != 0) return failed(temporary, "sync");
    return Done{};
}

Status FolderStore::replace(const std::string& name, std::span<const std::byte> bytes) {
    if (!isPlainFileName(name)) return Error{"'" + name + "' is not a plain file name"};
    if (m_appendedName == name) {
        m_appended = Descriptor();
        m_appendedName.clear();
    }
    const std::string temporary = name + std::string(temporarySuffix);
    if (Status written = writeTemporary(temporary, bytes); !written) {
        ::unlinkat(m_folder.number(), temporary.c_str(), 0);
        return written;
    }
    if (::renameat(m_folder.number(), temporary.c_str(), m_folder.number(), name.c_str()) != 0) {
        return failed(name, "rename a new file to");
    }
    return syncFolder(name);
}

Status FolderStore::remove(const std::string& name) {
    if (!isPlainFileName(name)) return Error{"'" + name + "' is not a plain file name"};
    if (::unlinkat(m_folder.number(), name.c_str(), 0) != 0) return failed(name, "remove");
    return Done{};
}

Status FolderStore::lockForWriting() {
    if (::flock(m_folder.number(), LOCK_EX | LOCK_NB) == 0) return removeTemporaries();
    if (errno == EWOULDBLOCK) return Error{m_path + ": is being written by another server"};
    return failed("", "lock");
}

/// What a `replace` left that never came to its end. Nobody else is in one: the folder is locked.
Status FolderStore::removeTemporaries() {
    const Result<std::vector<std::string>> names = everyFile();
    if (!names) return names.error();
    for (const std::string& name : *names) {
        if (!name.ends_with(temporarySuffix)) continue;
        if (Status removed = remove(name); !removed) return removed;
    }
    return Done{};
}

/// What was made in the folder is there after a power cut too.
Status syncAt(const std::filesystem::path& path) {
    const Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.open() && ::fsync(folder.number()) == 0) return Done{};
    return Error{path.string() +
                 ": cannot sync the folder: " + std::generic_category().message(errno)};
}

/// Makes the folder and those it lies in, each on disk before the next.
Status makeFolders(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return Done{};
    const std::filesystem::path parent = path.parent_path();
    if (parent != path) {
        if (Status made = makeFolders(parent); !made) return made;
    }
    std::filesystem::create_directory(path, error);
    if (error) {
        return Error{path.string() + ": " + error.message()};
    }
    return syncAt(parent);
}

}  // namespace

bool isPlainFileName(const std::string& name) {
    return !name.empty() && name.size() <= 100 && name[0] != '.' &&
           std::all_of(name.begin(), name.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '.' || c == '_' || c == '-';
           });
}

Result<std::unique_ptr<LogStore>> openFolder(const std::string& path) {
    std::error_code error;
    std::filesystem::path whole = std::filesystem::absolute(path, error).lexically_normal();
    if (error) return Error{path + ": cannot create the folder: " + error.message()};
    if (!whole.has_filename()) whole = whole.parent_path();
    if (Status made = makeFolders(whole); !made) {
        return Error{path + ": cannot create the folder: " + made.error().message};
    }
    Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!folder.open()) {
        return Error{path + ": cannot open: " + std::generic_category().message(errno)};
    }
    // Whoever made it may have died before its entry was on disk. A parent that may not be read
    // is of somebody else, who made the folder.
    const std::filesystem::path parent = whole.parent_path();
    if (::access(parent.c_str(), R_OK) == 0) {
        if (Status synced = syncAt(parent); !synced) return synced.error();
    }
    return std::unique_ptr<LogStore>(std::make_unique<FolderStore>(path, std::move(folder)));
}

}  // namespace huestep::protocol
