/// The options of `serve`, from the command line and from a file.
#pragma once

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
    bool open = false;
};

/// Fills what the command line left empty from the TOML file `options.config`, whose keys are the
/// options' names: `listen`, `web`, `data`, `session` (a list) and `open`. The sentence of a
/// failure names file and line, or the unknown key.
Status fillFromFile(ServeOptions& options);

}  // namespace huestep::tools
