// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/domain_check.hpp"

#include "transport/base/printable.hpp"
#include "transport/dds/catalogue.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <thread>

namespace tactus::hrtc
{

namespace
{

constexpr const char* kDomainCheck = "dds-domain";
constexpr std::chrono::milliseconds kLookEvery{20};
constexpr std::size_t kHeardShown = 8;

doctor::Finding not_joined(const Refusal& refusal)
{
    return {kDomainCheck,
            doctor::Verdict::critical,
            printable(refusal.text),
            "hrtc gets no models from this domain",
            {}};
}

/// Joins the names with commas, and shortens a long list.
std::string joined_names(const std::set<std::string>& names)
{
    std::string text;
    std::size_t shown = 0;
    for (const std::string& name : names)
    {
        if (shown == kHeardShown)
        {
            return text + fmt::format(" and {} more", names.size() - shown);
        }
        text += (shown++ == 0 ? "" : ", ") + name;
    }
    return text;
}

} // namespace

doctor::Finding check_domain(const dds::DomainChoice& choice, std::chrono::milliseconds wait)
{
    const std::uint32_t domain = choice.id;
    auto joined = dds::Domain::join(choice, dds::Party::controller);
    if (!joined)
    {
        return not_joined(joined.error());
    }
    std::string refused; // Last message of the catalogue.
    auto catalogue = dds::Catalogue::create(joined.value(), [&refused](const std::string& line)
                                            { refused = line; });
    if (!catalogue)
    {
        return not_joined(catalogue.error());
    }
    const auto end = std::chrono::steady_clock::now() + wait;
    while (std::chrono::steady_clock::now() < end)
    {
        std::this_thread::sleep_for(kLookEvery);
        catalogue.value().refresh();
    }
    const std::set<std::string> heard = joined.value().participants().names();
    const std::string models = catalogue.value().names();
    const std::string where =
        fmt::format("on domain {} within {} s", domain, static_cast<double>(wait.count()) / 1e3);
    const std::string more = refused.empty() ? "" : "; " + printable(refused);
    if (heard.empty())
    {
        return {kDomainCheck,
                doctor::Verdict::advice,
                "no program is heard " + where + more,
                "hrtc finds no model on this domain: " +
                    printable_line(dds::why_unheard(domain).value_or(
                        "no spm_publish runs on this domain, or CYCLONEDDS_URI names another "
                        "interface or other peers, or a firewall blocks DDS")),
                {fmt::format("spm_publish MODEL.spm --domain {}", domain),
                 fmt::format("sudo ss -ulpn '( sport >= :{} and sport <= :{} )'",
                             7'410 + 250 * domain, 7'429 + 250 * domain)}};
    }
    const bool has_models = models != "none";
    return {kDomainCheck,
            has_models ? doctor::Verdict::good : doctor::Verdict::advice,
            fmt::format("{} heard {}; models published: {}{}", joined_names(heard), where, models,
                        more),
            has_models ? "hrtc finds these models" : "hrtc finds no model on this domain",
            has_models ? std::vector<std::string>{}
                       : std::vector{fmt::format("spm_publish MODEL.spm --domain {}", domain)},
            true};
}

} // namespace tactus::hrtc
