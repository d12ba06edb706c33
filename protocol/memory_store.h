/// A disk in memory that fails on request, for tests and simulations.
#pragma once

#include <map>
#include <optional>

#include "protocol/log_store.h"

namespace huestep::protocol {

/// Keeps for each file what was written and how much of it has been synced. The owner of the store
/// plays fate between calls:
///
///     MemoryStore disk;
///     disk.dieAfter(17);        // the 18th change is cut short, all after it fail
///     ... a server writes ...
///     disk.crash(seed);         // what was not synced is torn or lost; the disk works again
///
/// Thread rule: one caller at a time. Deterministic: everything random is drawn from a seed.
class MemoryStore : public LogStore {
 public:
    explicit MemoryStore(std::string path = "memory") : m_path(std::move(path)) {}

    Result<std::vector<std::string>> list() override;
    Result<std::vector<std::byte>> read(const std::string& name) override;
    Status append(const std::string& name, std::span<const std::byte> bytes) override;
    Status sync(const std::string& name) override;
    Status truncate(const std::string& name, std::uint64_t size) override;
    Status replace(const std::string& name, std::span<const std::byte> bytes) override;
    Status remove(const std::string& name) override;
    std::string describe(const std::string& name) const override { return m_path + "/" + name; }

    /// The power fails: of what was not synced an arbitrary part is left. A file keeps its synced
    /// bytes; behind them any number of bytes, of which any blocks of 512 may read as zeros. The
    /// disk works again after it, unless it is full.
    void crash(std::uint64_t seed);
    /// The process dies within change number `changes` from now, counted from 0: an append leaves
    /// a part, other changes nothing, and everything fails from then on until `crash` or `revive`.
    void dieAfter(std::uint64_t changes);
    void revive();
    /// Most bytes of all files together; none: no limit. An append beyond it leaves a part.
    void setCapacity(std::optional<std::uint64_t> bytes) { m_capacity = bytes; }
    /// Syncs fail, and sync nothing.
    void setFailingSyncs(bool failing) { m_failingSyncs = failing; }
    /// Syncs say that they succeeded and sync nothing.
    void setLyingSyncs(bool lying) { m_lyingSyncs = lying; }

    /// Calls that change something, since the start.
    [[nodiscard]] std::uint64_t changes() const { return m_changes; }
    /// The bytes of a file, to look at or to spoil. The file must exist.
    std::vector<std::byte>& bytes(const std::string& name) { return m_files.at(name).data; }
    [[nodiscard]] std::uint64_t totalBytes() const;

 private:
    struct File {
        std::vector<std::byte> data;
        std::size_t synced = 0;
    };

    /// Counts a change; whether the process lives through it.
    bool survives();
    [[nodiscard]] Error failed(const std::string& name, const char* what) const;
    Result<File*> find(const std::string& name, const char* what);

    std::string m_path;
    std::map<std::string, File> m_files;
    std::optional<std::uint64_t> m_capacity;
    std::optional<std::uint64_t> m_diesAt;
    std::uint64_t m_changes = 0;
    bool m_failingSyncs = false;
    bool m_lyingSyncs = false;
};

}  // namespace huestep::protocol
