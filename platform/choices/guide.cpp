// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/guide.hpp"

#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/material_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

namespace
{

constexpr NumberRange kGuidePlace{-1'000.0, 1'000.0, "m"};
constexpr NumberRange kGuideAlong{-1e300, 1e300};
constexpr NumberRange kGuideStiffness{1.0, kStiffest_n_per_m, "N/m"};
constexpr NumberRange kGuideForce{0.01, 100.0, "N"};
constexpr NumberRange kOpening{0.0, 1.0, "m"};
constexpr NumberRange kOfGripper[] = {kOpening, kGuideStiffness, kGuideForce};
constexpr NumberRange kOfPointGuide[] = {kGuidePlace, kGuidePlace, kGuidePlace, kGuideStiffness,
                                         kGuideForce};
constexpr NumberRange kOfOtherGuides[] = {kGuidePlace, kGuidePlace, kGuidePlace,     kGuideAlong,
                                          kGuideAlong, kGuideAlong, kGuideStiffness, kGuideForce};

struct GuideForm
{
    GuideKind kind;
    NumberForm numbers;
};
constexpr GuideForm kGuideForms[] = {
    {GuideKind::point, {"point:X,Y,Z[,K[,F]]", kOfPointGuide}},
    {GuideKind::line, {"line:X,Y,Z,DX,DY,DZ[,K[,F]]", kOfOtherGuides}},
    {GuideKind::plane, {"plane:X,Y,Z,NX,NY,NZ[,K[,F]]", kOfOtherGuides}},
    {GuideKind::gripper, {"gripper:X[,K[,F]]", kOfGripper}},
};

/// So many of its numbers say where.
std::size_t places_of(GuideKind kind)
{
    return kind == GuideKind::gripper ? 1 : kind == GuideKind::point ? 3 : 6;
}

} // namespace

Result<GuideChoice, Refusal> parse_guide(std::string_view text)
{
    const auto word_of = [](std::string_view form) { return form.substr(0, form.find(':') + 1); };
    const auto* form =
        std::ranges::find_if(kGuideForms, [&](const GuideForm& each)
                             { return text.starts_with(word_of(each.numbers.text)); });
    if (form == std::end(kGuideForms))
    {
        return Refusal{fmt::format("'{}' is not {}, {}, {}, {} or none", printable(text),
                                   kGuideForms[0].numbers.text, kGuideForms[1].numbers.text,
                                   kGuideForms[2].numbers.text, kGuideForms[3].numbers.text)};
    }
    const auto numbers = read_numbers(text, form->numbers);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    const std::size_t places = places_of(form->kind);
    GuideChoice guide;
    guide.words = text;
    guide.kind = form->kind;
    guide.at_m = places == 1 ? Vec3(n[0], 0.0, 0.0) : Vec3(n[0], n[1], n[2]);
    if (places == 6)
    {
        guide.direction = Vec3(n[3], n[4], n[5]);
        const double length = guide.direction.stableNorm();
        if (!(length > 0.0))
        {
            return not_of_form(text, form->numbers.text, "its direction is 0,0,0");
        }
        guide.direction /= length;
    }
    guide.stiffness_n_per_m = n.size() > places ? n[places] : guide.stiffness_n_per_m;
    guide.force_max_n = n.size() > places + 1 ? n[places + 1] : guide.force_max_n;
    return guide;
}

Guide::Guide(const GuideChoice& choice) noexcept
    : kind_(choice.kind)
    , at_m_(choice.at_m)
    , direction_(choice.direction)
    , stiffness_n_per_m_(choice.stiffness_n_per_m)
    , force_max_n_(choice.force_max_n)
{
}

OwnForce Guide::next(const DeviceSample& sample, const ToolState& tool,
                     const ToolOutput& /*output*/) noexcept
{
    if (kind_ == GuideKind::gripper)
    {
        last_ = sample.valid && sample.gripper_m ? grip(*sample.gripper_m) : last_;
    }
    else if (tool.valid && tool.position_m.allFinite())
    {
        last_ = spring_to(nearest_allowed(tool.position_m), tool.position_m, stiffness_n_per_m_,
                          force_max_n_);
    }
    return last_;
}

OwnForce Guide::grip(double open_m) const noexcept
{
    OwnForce spring = last_;
    if (std::isfinite(open_m))
    {
        spring.gripper_n =
            std::clamp(stiffness_n_per_m_ * (at_m_.x() - open_m), -force_max_n_, force_max_n_);
    }
    return spring;
}

Vec3 Guide::nearest_allowed(const Vec3& place_m) const noexcept
{
    const double along_m = direction_.dot(place_m - at_m_);
    switch (kind_)
    {
    case GuideKind::point:
    case GuideKind::gripper:
        break;
    case GuideKind::line:
        return at_m_ + along_m * direction_;
    case GuideKind::plane:
        return place_m + std::max(0.0, -along_m) * direction_;
    }
    return at_m_;
}

} // namespace tactus::hrtc
