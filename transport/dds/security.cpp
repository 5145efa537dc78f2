// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/security.hpp"

#include "transport/base/read_file.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_xqos.h>
#include <dds/ddsrt/process.h>
#include <dds/ddsrt/sockets.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
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

/// Text of the XML elements, including those of named files, without comments.
std::string configuration_text(const std::string& uri)
{
    std::string text;
    for (std::size_t at = 0; at < uri.size();)
    {
        if (uri[at] == '<')
        {
            text += uri.substr(at); // Elements end the list of files.
            break;
        }
        const std::size_t end = std::min(uri.find(',', at), uri.size());
        std::string path = uri.substr(at, end - at);
        path = path.starts_with("file://") ? path.substr(7) : path;
        const auto bytes = read_file(path, kMostBytes);
        text += bytes ? bytes.value() : "";
        at = end + 1;
    }
    for (std::size_t from = 0; (from = text.find("<!--", from)) != std::string::npos;)
    {
        const std::size_t end = text.find("-->", from);
        text.erase(from, end == std::string::npos ? end : end + 3 - from);
    }
    return text;
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
    const std::string text = configuration_text(cyclonedds_uri);
    const std::string_view all = text;
    if (text.empty() || all.find("<Security") != std::string_view::npos)
    {
        return false;
    }
    constexpr std::string_view kElement = "<NetworkInterface";
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
