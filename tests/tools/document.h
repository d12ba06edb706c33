/// What commands print with --json.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/process.h"

namespace huestep::test {

using Json = nlohmann::json;

/// The one JSON document of a command that must end with `status`.
inline Json documentOf(std::vector<std::string> words, int status = 0) {
    words.push_back("--json");
    const Ended ended = huestep(words);
    EXPECT_EQ(ended.status, status) << ended.err;
    Json document = Json::parse(ended.out, nullptr, false);
    EXPECT_FALSE(document.is_discarded()) << ended.out;
    return document;
}

}  // namespace huestep::test
