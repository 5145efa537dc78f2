// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/guide.hpp"

#include "host_tools/scene/material_ranges.hpp"
#include "platform/base/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

namespace
{

constexpr double kPlaceMax_m = 1'000.0;
constexpr double kForceMin_n = 0.01;
constexpr double kForceMax_n = 100.0;

} // namespace

std::optional<GuideChoice> parse_guide(std::string_view text)
{
    static constexpr std::array<std::pair<std::string_view, GuideKind>, 3> kForms{
        {{"point:", GuideKind::point}, {"line:", GuideKind::line}, {"plane:", GuideKind::plane}}};
    const auto* form = std::ranges::find_if(kForms, [text](const auto& entry)
                                            { return text.starts_with(entry.first); });
    if (form == kForms.end())
    {
        return std::nullopt;
    }
    const auto numbers = parse_numbers(text.substr(form->first.size()));
    const std::size_t places = form->second == GuideKind::point ? 3 : 6;
    if (!numbers || numbers->size() < places || numbers->size() > places + 2)
    {
        return std::nullopt;
    }
    const std::vector<double>& n = *numbers;
    GuideChoice guide;
    guide.words = text;
    guide.kind = form->second;
    guide.at_m = Vec3(n[0], n[1], n[2]);
    double length = 1.0;
    if (places == 6)
    {
        guide.direction = Vec3(n[3], n[4], n[5]);
        length = guide.direction.stableNorm();
        guide.direction /= length;
    }
    guide.stiffness_n_per_m = n.size() > places ? n[places] : guide.stiffness_n_per_m;
    guide.force_max_n = n.size() > places + 1 ? n[places + 1] : guide.force_max_n;
    const bool is_good = guide.at_m.cwiseAbs().maxCoeff() <= kPlaceMax_m && length > 0.0 &&
                         guide.direction.allFinite() && guide.stiffness_n_per_m >= 1.0 &&
                         guide.stiffness_n_per_m <= kStiffest_n_per_m &&
                         guide.force_max_n >= kForceMin_n && guide.force_max_n <= kForceMax_n;
    return is_good ? std::optional(std::move(guide)) : std::nullopt;
}

Guide::Guide(const GuideChoice& choice) noexcept
    : kind_(choice.kind)
    , at_m_(choice.at_m)
    , direction_(choice.direction)
    , stiffness_n_per_m_(choice.stiffness_n_per_m)
    , force_max_n_(choice.force_max_n)
{
}

OwnForce Guide::next(const DeviceSample& /*sample*/, const ToolState& tool,
                     const ToolOutput& /*output*/) noexcept
{
    if (tool.valid && tool.position_m.allFinite())
    {
        last_ = spring_to(nearest_allowed(tool.position_m), tool.position_m, stiffness_n_per_m_,
                          force_max_n_);
    }
    return last_;
}

Vec3 Guide::nearest_allowed(const Vec3& place_m) const noexcept
{
    const double along_m = direction_.dot(place_m - at_m_);
    switch (kind_)
    {
    case GuideKind::point:
        break;
    case GuideKind::line:
        return at_m_ + along_m * direction_;
    case GuideKind::plane:
        return place_m + std::max(0.0, -along_m) * direction_;
    }
    return at_m_;
}

} // namespace tactus::hrtc
