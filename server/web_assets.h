/// The files of client/web, embedded when the server is built (server/web_assets.cmake): there is
/// no folder to find at run time, and no path of a request ever reaches a file system.
#pragma once

#include <span>
#include <string_view>

namespace huestep::server {

struct WebAsset {
    std::string_view name;      ///< file name in client/web, such as "main.js"
    std::string_view type;      ///< MIME type with charset
    std::string_view body;      ///< UTF-8, or a WebAssembly module
    std::string_view encoding;  ///< of the body, as HTTP names it; empty: as it is
};

/// All of them, sorted by name.
std::span<const WebAsset> webAssets();

/// None: null.
const WebAsset* findWebAsset(std::string_view name);

}  // namespace huestep::server
