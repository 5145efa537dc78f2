// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/fixture.hpp"

#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/material_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace tactus::hrtc
{

namespace
{

constexpr NumberRange kFixturePlace{-1'000.0, 1'000.0, "m"};
constexpr NumberRange kFixtureAlong{-1e300, 1e300};
constexpr NumberRange kFixtureStiffness{1.0, kStiffest_n_per_m, "N/m"};
constexpr NumberRange kFixtureForce{0.01, 100.0, "N"};
constexpr NumberRange kOpening{0.0, 1.0, "m"};
constexpr NumberRange kOfGripper[] = {kOpening, kFixtureStiffness, kFixtureForce};
constexpr NumberRange kOfPointFixture[] = {kFixturePlace, kFixturePlace, kFixturePlace,
                                           kFixtureStiffness, kFixtureForce};
constexpr NumberRange kOfOtherFixtures[] = {kFixturePlace,     kFixturePlace, kFixturePlace,
                                            kFixtureAlong,     kFixtureAlong, kFixtureAlong,
                                            kFixtureStiffness, kFixtureForce};

struct FixtureForm
{
    FixtureKind kind;
    NumberForm numbers;
};
constexpr FixtureForm kFixtureForms[] = {
    {FixtureKind::point, {"point:X,Y,Z[,K[,F]]", kOfPointFixture}},
    {FixtureKind::line, {"line:X,Y,Z,DX,DY,DZ[,K[,F]]", kOfOtherFixtures}},
    {FixtureKind::plane, {"plane:X,Y,Z,NX,NY,NZ[,K[,F]]", kOfOtherFixtures}},
    {FixtureKind::gripper, {"gripper:X[,K[,F]]", kOfGripper}},
};

/// Number of leading numbers in the text that give the fixture's place and direction.
std::size_t places_of(FixtureKind kind)
{
    return kind == FixtureKind::gripper ? 1 : kind == FixtureKind::point ? 3 : 6;
}

} // namespace

Result<FixtureChoice, Refusal> parse_fixture(std::string_view text)
{
    const auto word_of = [](std::string_view form) { return form.substr(0, form.find(':') + 1); };
    const auto* form =
        std::ranges::find_if(kFixtureForms, [&](const FixtureForm& each)
                             { return text.starts_with(word_of(each.numbers.text)); });
    if (form == std::end(kFixtureForms))
    {
        return Refusal{fmt::format("'{}' is not {}, {}, {}, {} or none", printable(text),
                                   kFixtureForms[0].numbers.text, kFixtureForms[1].numbers.text,
                                   kFixtureForms[2].numbers.text, kFixtureForms[3].numbers.text)};
    }
    const auto numbers = read_numbers(text, form->numbers);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    const std::size_t places = places_of(form->kind);
    FixtureChoice fixture;
    fixture.words = text;
    fixture.kind = form->kind;
    fixture.at_m = places == 1 ? Vec3(n[0], 0.0, 0.0) : Vec3(n[0], n[1], n[2]);
    if (places == 6)
    {
        fixture.direction = Vec3(n[3], n[4], n[5]);
        const double length = fixture.direction.stableNorm();
        if (!(length > 0.0))
        {
            return not_of_form(text, form->numbers.text, "the direction is 0,0,0");
        }
        fixture.direction /= length;
    }
    fixture.stiffness_n_per_m = n.size() > places ? n[places] : fixture.stiffness_n_per_m;
    fixture.force_max_n = n.size() > places + 1 ? n[places + 1] : fixture.force_max_n;
    return fixture;
}

VirtualFixture::VirtualFixture(const FixtureChoice& choice) noexcept
    : kind_(choice.kind)
    , at_m_(choice.at_m)
    , direction_(choice.direction)
    , stiffness_n_per_m_(choice.stiffness_n_per_m)
    , force_max_n_(choice.force_max_n)
{
}

ExternalForce VirtualFixture::next(const DeviceSample& sample, const ToolState& tool,
                                   const ToolOutput& /*output*/) noexcept
{
    if (kind_ == FixtureKind::gripper)
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

ExternalForce VirtualFixture::grip(double open_m) const noexcept
{
    ExternalForce spring = last_;
    if (std::isfinite(open_m))
    {
        spring.gripper_n =
            std::clamp(stiffness_n_per_m_ * (at_m_.x() - open_m), -force_max_n_, force_max_n_);
    }
    return spring;
}

Vec3 VirtualFixture::nearest_allowed(const Vec3& place_m) const noexcept
{
    const double along_m = direction_.dot(place_m - at_m_);
    switch (kind_)
    {
    case FixtureKind::point:
    case FixtureKind::gripper:
        break;
    case FixtureKind::line:
        return at_m_ + along_m * direction_;
    case FixtureKind::plane:
        return place_m + std::max(0.0, -along_m) * direction_;
    }
    return at_m_;
}

} // namespace tactus::hrtc
