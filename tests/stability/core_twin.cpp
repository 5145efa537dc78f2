// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/core_twin.hpp"

#include "rt_core/query/contact_report.hpp"
#include "rt_core/query/core_query.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/stability/same_bits.hpp"

#include <Eigen/Geometry>

namespace tactus::test
{

namespace
{

struct Findings
{
    OwnedSurface surface;
    ContactReport report;

    Findings(const AbTree& tree, const PlacedCore& core, double radius_m, bool is_closed)
    {
        QueryMemory memory;
        WalkBudget budget{1'000'000'000, 1'000'000'000};
        gather_surface(tree, core, 1.05 * radius_m, memory, budget, surface);
        report_contacts(core, radius_m, tree, surface, is_closed, report);
    }
};

bool same_answer(const DistanceAnswer& a, const DistanceAnswer& b)
{
    return a.kind == b.kind && a.nearest_face == b.nearest_face &&
           a.nearest_feature == b.nearest_feature && same_bits(a.lower_m, b.lower_m) &&
           same_bits(a.upper_m, b.upper_m) && same_bits(a.nearest_point_m, b.nearest_point_m) &&
           same_bits(a.tool_point_m, b.tool_point_m);
}

} // namespace

PlacedCore twin_core(std::uint32_t turn, const Vec3& center_m, double size_m, Random& random)
{
    static const std::array<Vec3, 5> kWedge{Vec3(-0.5, 0, 0), Vec3(0.5, 0, 0), Vec3(0, 0.6, 0),
                                            Vec3(0, 0, 0.7), Vec3(0.2, 0.2, 0.2)};
    static const Hull wedge = Hull::create(kWedge).value();
    const Eigen::Quaterniond rotation(random.between(0.1, 1.0), random.between(-1.0, 1.0),
                                      random.between(-1.0, 1.0), random.between(-1.0, 1.0));
    const Similarity place{rotation.normalized().toRotationMatrix(), center_m, size_m};
    switch (turn % 4)
    {
    case 0:
        return {PointCore{}, place};
    case 1:
        return {Segment{Vec3(-0.5, 0.0, 0.0), Vec3(0.5, 0.0, 0.0)}, place};
    case 2:
        return {Box{Vec3(0.5, 0.3, 0.1)}, place};
    default:
        return {wedge, place};
    }
}

std::optional<std::string> core_difference(const AbTree& refined, const AbTree& whole,
                                           const PlacedCore& core, double radius_m, bool is_closed)
{
    const Findings ours(refined, core, radius_m, is_closed);
    const Findings full(whole, core, radius_m, is_closed);
    const DistanceAnswer& a = ours.surface.answer;
    const DistanceAnswer& b = full.surface.answer;
    if (a.certified_radius_m < radius_m)
    {
        return std::nullopt;
    }
    if (a.kind == AnswerKind::exact ? !same_answer(a, b) : b.upper_m <= radius_m)
    {
        return "the nearest points differ";
    }
    if (!same_bits(ours.report.contacts, full.report.contacts) ||
        ours.report.is_complete != full.report.is_complete)
    {
        return "the contacts differ";
    }
    if (a.kind == AnswerKind::exact && (!same_bits(ours.report.normal, full.report.normal) ||
                                        ours.report.side != full.report.side))
    {
        return "the normals or sides differ";
    }
    return "";
}

} // namespace tactus::test
