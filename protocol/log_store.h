/// The few things a journal needs of a file system, so that a test can tear, lose, lie and fail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace huestep::protocol {

/// One folder of files. Names are plain file names: 1 to 100 of A-Z, a-z, 0-9, `.`, `_` and `-`,
/// not starting with a dot. Every call may fail with a sentence that names the file.
/// Thread rule: one caller at a time.
class LogStore {
 public:
    virtual ~LogStore() = default;
    virtual Result<std::vector<std::string>> list() = 0;  ///< sorted
    virtual Result<std::vector<std::byte>> read(const std::string& name) = 0;
    /// To the end of a file that is there.
    virtual Status append(const std::string& name, std::span<const std::byte> bytes) = 0;
    virtual Status sync(const std::string& name) = 0;  ///< data is on disk on return
    virtual Status truncate(const std::string& name, std::uint64_t size) = 0;
    /// Temporary file, sync, rename, sync of the folder: all or nothing.
    virtual Status replace(const std::string& name, std::span<const std::byte> bytes) = 0;
    virtual Status remove(const std::string& name) = 0;
    [[nodiscard]] virtual std::string describe(const std::string& name) const = 0;  ///< path
    /// Keeps every other store of this folder from locking it, in this process or another, until
    /// this one is destroyed. Reading needs no lock. Locking again what one holds is fine. Removes
    /// what an interrupted `replace` left.
    virtual Status lockForWriting() { return Done{}; }
};

/// Whether it is a plain file name as `LogStore` takes them.
bool isPlainFileName(const std::string& name);

/// A store in a folder of the file system, created if missing, with the folders it lies in; each
/// is on disk before the next. Names that end in `.tmp` are the store's own and are not listed.
Result<std::unique_ptr<LogStore>> openFolder(const std::string& path);

}  // namespace huestep::protocol
