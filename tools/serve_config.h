/// The options of `serve`, from the command line and from a file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"

namespace huestep::tools {

struct ServeOptions {
    std::string config;
    std::string listen;
    std::string web;
    std::string data;
    std::vector<std::string> sessions;  ///< NAME=SCENE
    /// Ticks between an input and its frame: `N`, `LOW-HIGH`, or `adaptive`; empty: 0.
    std::string inputDelay;
    bool open = false;
    std::string tickets;  ///< key file of a host
    std::string tlsCertificates;
    std::string tlsKey;
};

struct InputDelay {
    std::uint32_t least = 0;
    std::uint32_t most = 0;  ///< to which clients that predict adapt theirs
};
/// Of `ServeOptions::inputDelay`, each at most 60.
Result<InputDelay> parseInputDelay(const std::string& text);

/// Fills what the command line left empty from the TOML file `options.config`, whose keys are the
/// options' names: `listen`, `web`, `data`, `session` (a list), `input-delay`, `tickets`,
/// `tls-cert`, `tls-key` and `open`. The sentence of a failure names file and line, or the unknown
/// key.
Status fillFromFile(ServeOptions& options);

}  // namespace huestep::tools
