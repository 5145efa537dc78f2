// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/model_name.hpp"

#include "transport/base/printable.hpp"

#include <algorithm>

namespace tactus
{

bool is_name_character(std::string_view character) noexcept
{
    const char c = character.empty() ? ' ' : character.front();
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-' || is_letter(character);
}

bool is_valid_name(std::string_view name) noexcept
{
    if (name.empty() || name.size() > kMaxNameBytes)
    {
        return false;
    }
    while (!name.empty())
    {
        const std::size_t bytes = character_bytes(name);
        if (bytes == 0 || !is_name_character(name.substr(0, bytes)))
        {
            return false;
        }
        name.remove_prefix(bytes);
    }
    return true;
}

bool is_valid_server(std::string_view server) noexcept
{
    constexpr std::size_t kMachineBytes = 64; // HOST_NAME_MAX of Linux.
    constexpr std::size_t kProcessDigits = 10;
    constexpr std::size_t kCertificateDigits = 12;
    const auto is_of = [](std::string_view text, std::string_view characters)
    { return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos; };
    const std::size_t colon = std::min(server.find(':'), server.size());
    const std::string_view machine = server.substr(0, colon);
    const bool has_more = colon < server.size();
    const std::string_view more = server.substr(has_more ? colon + 1 : colon);
    if (has_more && machine == "cert")
    {
        return more.size() == kCertificateDigits && is_of(more, "0123456789abcdef");
    }
    return !machine.empty() && machine.size() <= kMachineBytes &&
           std::ranges::all_of(machine,
                               [](char c) {
                                   return is_name_character({&c, 1});
                               }) &&
           (!has_more || (more.size() <= kProcessDigits && is_of(more, "0123456789")));
}

Result<ModelSelector, Refusal> parse_selector(std::string_view text)
{
    const std::size_t at = text.find('@');
    ModelSelector selector;
    selector.name = text.substr(0, at);
    if (!is_valid_name(selector.name))
    {
        return Refusal{"name '" + printable(selector.name) + "' is not " + std::string(kNameForm)};
    }
    if (at != std::string_view::npos)
    {
        const std::string_view pin = text.substr(at + 1);
        selector.hash = parse_hash(pin);
        if (!selector.hash && !is_valid_server(pin))
        {
            return Refusal{"'" + printable(pin) +
                           "' after @ is neither a hash of 32 hexadecimal digits nor a server, "
                           "MACHINE[:PROCESS] or cert: and 12 digits of 0-9 a-f"};
        }
        selector.server = selector.hash ? "" : pin;
    }
    return selector;
}

} // namespace tactus
