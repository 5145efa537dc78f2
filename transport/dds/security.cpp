// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/read_file.hpp"
#include "transport/dds/key_folder.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_xqos.h>
#include <dds/ddsrt/process.h>
#include <dds/ddsrt/sockets.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace tactus::dds
{

namespace
{

constexpr std::uintmax_t kMostBytes = 1U << 20U;

void set_plugin(dds_qos* qos, const std::string& kind, const char* library, const char* function)
{
    const std::string prefix = "dds.sec." + kind + ".library.";
    dds_qset_prop(qos, (prefix + "path").c_str(), library);
    dds_qset_prop(qos, (prefix + "init").c_str(), (std::string("init_") + function).c_str());
    dds_qset_prop(qos, (prefix + "finalize").c_str(),
                  (std::string("finalize_") + function).c_str());
}

/// Adds program, process and machine, which Cyclone adds only to participants without properties.
/// Unknown values are left out.
void tell_of_process(dds_qos* qos)
{
    constexpr bool kToOthers = true;
    constexpr std::size_t kMost = 256;
    std::array<char, kMost> machine{};
    if (ddsrt_gethostname(machine.data(), machine.size()) == DDS_RETCODE_OK)
    {
        ddsi_xqos_add_property_if_unset(qos, kToOthers, "__Hostname", machine.data());
    }
    const ddsrt_pid_t process = ddsrt_getpid();
    ddsi_xqos_add_property_if_unset(qos, kToOthers, "__Pid", std::to_string(process).c_str());
    if (char* program = ddsrt_getprocessname(); program != nullptr)
    {
        ddsi_xqos_add_property_if_unset(qos, kToOthers, "__ProcessName", program);
        dds_free(program);
    }
}

constexpr std::string_view kBlanks = " \t\n\v\f\r";

std::string without_comments(std::string text)
{
    for (std::size_t from = 0; (from = text.find("<!--", from)) != std::string::npos;)
    {
        const std::size_t end = text.find("-->", from);
        text.erase(from, end == std::string::npos ? end : end + 3 - from);
    }
    return text;
}

/// End of the elements at the beginning of `list`: the next comma between two elements, or the end.
std::size_t end_of_elements(std::string_view list)
{
    for (std::size_t at = list.find('>'); at != std::string_view::npos; at = list.find('>', at + 1))
    {
        const std::size_t next = list.find_first_not_of(kBlanks, at + 1);
        if (next != std::string_view::npos && list[next] == ',')
        {
            return next;
        }
    }
    return list.size();
}

struct Configuration
{
    std::string text; ///< Elements in small letters, without comments, with a space for each blank.
    bool lacks_file{false};      ///< True if a named file is missing: Cyclone refuses.
    bool has_unread_file{false}; ///< True if a named file could not be searched.
};

void add_file(Configuration& configuration, const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::exists(path, error))
    {
        configuration.lacks_file = true;
        return;
    }
    auto bytes = read_file(path, kMostBytes);
    configuration.has_unread_file = configuration.has_unread_file || !bytes;
    configuration.text += bytes ? without_comments(std::move(bytes).value()) : "";
}

/// Reads a list of elements and files, separated by commas, as Cyclone does.
Configuration read_configuration(const std::string& uri)
{
    constexpr std::string_view kFile = "file://";
    Configuration configuration;
    const std::string plain = without_comments(uri);
    std::string_view list = plain;
    const std::string separators = std::string(kBlanks) + ",";
    for (std::size_t at = 0; (at = list.find_first_not_of(separators)) != std::string_view::npos;)
    {
        list.remove_prefix(at);
        const bool is_file = list.front() != '<';
        const std::size_t end =
            is_file ? std::min(list.find(','), list.size()) : end_of_elements(list);
        const std::string_view part = list.substr(0, end);
        list.remove_prefix(end);
        if (is_file)
        {
            add_file(configuration,
                     std::string(part.substr(part.starts_with(kFile) ? kFile.size() : 0)));
        }
        else
        {
            configuration.text += part;
        }
    }
    std::ranges::transform(
        configuration.text, configuration.text.begin(),
        [](char c)
        {
            const bool is_blank = kBlanks.find(c) != std::string_view::npos;
            const bool is_capital = c >= 'A' && c <= 'Z';
            return is_blank ? ' ' : is_capital ? static_cast<char>(c - 'A' + 'a') : c;
        });
    return configuration;
}

/// Value in quotes of the attribute `word`; empty if the element has none.
std::string_view attribute(std::string_view element, std::string_view word)
{
    const std::size_t found = element.find(word);
    const std::size_t open = element.find_first_of("\"'", found);
    if (found == std::string_view::npos || open == std::string_view::npos)
    {
        return {};
    }
    const std::size_t close = element.find(element[open], open + 1);
    return element.substr(open + 1, close - open - 1);
}

} // namespace

void protect(dds_qos* participant, const KeyFolder& keys)
{
    tell_of_process(participant);
    set_plugin(participant, "auth", "dds_security_auth", "authentication");
    set_plugin(participant, "crypto", "dds_security_crypto", "crypto");
    set_plugin(participant, "access", "dds_security_ac", "access_control");
    constexpr std::pair<const char*, const char*> kProperties[] = {
        {"dds.sec.auth.identity_ca", kIdentityCaFile},
        {"dds.sec.auth.identity_certificate", kIdentityFile},
        {"dds.sec.auth.private_key", kKeyFile},
        {"org.eclipse.cyclonedds.sec.auth.crl", kCrlFile},
        {"dds.sec.access.permissions_ca", kPermissionsCaFile},
        {"dds.sec.access.governance", kGovernanceFile},
        {"dds.sec.access.permissions", kPermissionsFile},
    };
    for (const auto& [name, file] : kProperties)
    {
        dds_qset_prop(participant, name, ("file:" + keys.path + "/" + file).c_str());
    }
}

bool is_open_to_network(const std::string& cyclonedds_uri)
{
    const Configuration configuration = read_configuration(cyclonedds_uri);
    const std::string_view all = configuration.text;
    if (cyclonedds_uri.empty() || configuration.lacks_file ||
        all.find("<security") != std::string_view::npos)
    {
        return false;
    }
    if (configuration.has_unread_file)
    {
        return true;
    }
    constexpr std::string_view kElement = "<networkinterface";
    std::size_t at = all.find(kElement);
    bool is_open = at == std::string_view::npos;
    for (; at != std::string_view::npos; at = all.find(kElement, at + 1))
    {
        const std::string_view element = all.substr(at, all.find('>', at) - at);
        const std::string_view address = attribute(element, " address");
        is_open = is_open || (attribute(element, " name") != "lo" && !address.starts_with("127."));
    }
    return is_open;
}

} // namespace tactus::dds
