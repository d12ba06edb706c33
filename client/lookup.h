/// The addresses of a name.
///
/// The system's resolver blocks for as long as it likes and cannot be interrupted, so it runs on a
/// thread of its own that is left behind by whoever no longer wants to know. (libuv's lookup also
/// runs on a thread, but its loop and the program's end wait for that.)
#pragma once

#include <sys/socket.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/result.h"
#include "protocol/address.h"

namespace huestep::client {

/// At least one, best first; with the port.
using SocketAddresses = std::vector<sockaddr_storage>;

/// Turns a name or number into addresses; may block. Runs on a thread of its own, and maybe still
/// when its caller is gone: it captures nothing that may go.
using Resolve = std::function<Result<SocketAddresses>(const protocol::Address&)>;

/// Asks the system, as every program does.
Result<SocketAddresses> askSystem(const protocol::Address& address);

/// One lookup under way. Thread rule: made, asked and destroyed on one thread.
class Lookup {
 public:
    /// Starts. `done` is called once, on another thread or at once, never after the destructor.
    Lookup(Resolve resolve, protocol::Address address, std::function<void()> done);
    /// Does not wait for the resolver.
    ~Lookup();
    Lookup(const Lookup&) = delete;
    Lookup& operator=(const Lookup&) = delete;

    /// What was found, once `done` was called. Takes it out.
    std::optional<Result<SocketAddresses>> take();

 private:
    struct Shared;
    std::shared_ptr<Shared> m_shared;  ///< with the thread
};

}  // namespace huestep::client
