#include "tools/ticket_text.h"

#include <iostream>
#include <string_view>

#include "protocol/codec.h"
#include "protocol/keys.h"
#include "tools/files.h"

namespace huestep::tools {
namespace {

constexpr std::size_t maxText = 4 * protocol::maxTicketBytes;  ///< with blanks around it

Result<std::string> textOf(const std::string& path) {
    if (path == "-") {
        std::string text(maxText + 1, '\0');
        std::cin.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(std::cin.gcount()));
        if (text.size() > maxText) return Error{"standard input is longer than a ticket"};
        return text;
    }
    const Result<std::vector<std::byte>> bytes = readFile(path, maxText);
    if (!bytes) return bytes.error();
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

}  // namespace

Result<std::vector<std::byte>> readTicket(const std::string& path) {
    if (path.empty()) return std::vector<std::byte>();
    const Result<std::string> text = textOf(path);
    if (!text) return text.error();
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t begin = text->find_first_not_of(blanks);
    const std::size_t end = text->find_last_not_of(blanks);
    const std::string name = path == "-" ? "standard input" : path;
    if (begin == std::string::npos) return Error{name + ": there is no ticket in it"};
    auto ticket = protocol::fromUrlText(text->substr(begin, end + 1 - begin));
    if (!ticket || ticket->size() > protocol::maxTicketBytes)
        return Error{name + ": not a ticket as huestep ticket issue prints it"};
    return *std::move(ticket);
}

}  // namespace huestep::tools
