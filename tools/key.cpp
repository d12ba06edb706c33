/// `huestep key`: a pair of keys to sign with and to check by.
#include <cstdio>
#include <memory>

#include "tools/command.h"
#include "tools/key_files.h"

namespace huestep::tools {
namespace {

Answer makePair(const std::string& name) {
    const protocol::Keys keys = protocol::makeKeys(false);
    const std::string secret = name + ".secret.key";
    const std::string open = name + ".public.key";
    if (const Status written = writeKeyFile(secret, keys); !written) return written.error();
    if (const Status written = writeKeyFile(open, protocol::withoutSigning(keys)); !written)
        return written.error();
    std::printf("%s  signs; keep it to yourself\n%s  checks; give it to anyone\n", secret.c_str(),
                open.c_str());
    return Exit::Done;
}

}  // namespace

void addKey(Menu& menu) {
    const auto name = std::make_shared<std::string>();
    CLI::App* sub = menu.add("key",
                             "Makes a pair of Ed25519 keys: NAME.secret.key, which signs, and "
                             "NAME.public.key, which checks.",
                             "huestep key referee", [name] { return makePair(*name); });
    sub->add_option("NAME", *name, "How the two files' names begin")->required();
}

}  // namespace huestep::tools
