// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `encoder`: our encoder on well-known and on difficult meshes, compared with the peers that
/// simplify. Lists the meshes with their goals.

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/encoder_cases.hpp"
#include "tests/bench/suites.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>

namespace tactus::bench
{

namespace
{

/// 1.3 million records a second.
constexpr double kReadGoal_ns = 1e3 / 1.3;

using MakeMesh = std::function<NamedMesh()>;

MakeMesh from(const SceneSource& source)
{
    return [source] { return source_mesh(source); };
}

MakeMesh shape(Shape shape, std::uint32_t faces)
{
    return [shape, faces]
    {
        const std::string name(shape_names()[static_cast<std::size_t>(shape)]);
        return NamedMesh(
            NamedMesh{fmt::format("{}-{}", name, faces), make_shape(shape, faces).value()});
    };
}

MakeMesh uv_sphere(std::uint32_t rings, std::uint32_t segments)
{
    return [rings, segments]
    {
        return NamedMesh(NamedMesh{fmt::format("uv-sphere-{}x{}", rings, segments),
                                   make_uv_sphere(rings, segments).value()});
    };
}

/// Goals of every mesh.
EncoderGoals usual_goals()
{
    EncoderGoals goals;
    goals.us_per_face = 18.0;
    goals.us_per_face_on_two = 10.0;
    goals.read_ns_per_record = kReadGoal_ns;
    goals.base_faces = 500.0;
    goals.bound_at_sixth = 1.4;
    goals.bound_at_two_thirds = 3.5;
    return goals;
}

/// Additional goals of the well-known meshes; none for their stand-ins.
EncoderGoals known_goals()
{
    EncoderGoals goals = usual_goals();
    if (std::getenv("TACTUS_MESHES") != nullptr)
    {
        goals.rms_to_garland_heckbert = 1.15;
        goals.max_to_garland_heckbert = 1.0;
        goals.rms_to_meshoptimizer = 0.75;
    }
    return goals;
}

EncoderGoals with_size(EncoderGoals goals, double bytes_per_face, double fine_bytes_per_face)
{
    goals.file_bytes_per_face = bytes_per_face;
    goals.fine_file_bytes_per_face = fine_bytes_per_face;
    return goals;
}

/// Goals from a million faces on, where fixed costs no longer hide the growth.
EncoderGoals large_goals()
{
    EncoderGoals goals = with_size(usual_goals(), 4.3, 5.1);
    goals.peak_bytes_per_face = 350.0;
    goals.exact_splits = 250.0;
    return goals;
}

EncoderGoals largest_goals()
{
    EncoderGoals goals = large_goals();
    goals.seconds = 90.0;
    goals.contact_kb = 80.0;
    goals.hashed_contact_kb = 110.0;
    return goals;
}

std::vector<EncoderMesh> all_meshes()
{
    constexpr SceneSource kCow{"cow", "cow.obj", 0, 5'804};
    constexpr SceneSource kTeapot{"teapot", "teapot.obj", 0, 6'320};
    constexpr SceneSource kFandiskMesh{"fandisk", "fandisk.obj", 0, 12'946};
    constexpr SceneSource kIgeaMesh{"igea", "igea.ply", 0, 268'686};
    const EncoderGoals known = known_goals();
    const EncoderGoals usual = usual_goals();
    const EncoderGoals scanned = with_size(known, 4.6, 5.4);
    const EncoderGoals large = large_goals();
    using enum When;
    return {
        {"cow", always, from(kCow), known},
        {"teapot", always, from(kTeapot), known},
        {"fandisk", always, from(kFandiskMesh), known, Feature::sharp_edges},
        {"bunny", always, from(kBunny), scanned, Feature::borders},
        {"igea", full_only, from(kIgeaMesh), scanned},
        {"sphere", full_only, shape(Shape::sphere, 81'920), usual},
        {"needles", always, uv_sphere(20, 4'000), usual, Feature::none, false},
        {"poles", full_only, uv_sphere(3, 4'000), usual, Feature::none, false},
        {"bumpy-1.1M", full_only, shape(Shape::bumpy_sphere, 1'100'000), large},
        {"bunny-1.1M", full_only, from(kFineBunny), large, Feature::borders},
        {"igea-4.3M", named_only, from(kFineIgea), largest_goals()},
        {"tiny-gear", named_only, shape(Shape::gear, 4'000), {}, Feature::sharp_edges},
        {"tiny-terrain", named_only, shape(Shape::terrain, 4'000), {}, Feature::borders},
    };
}

/// Parts of the suite in their order. Files are first, since processes that measure memory inherit
/// ours.
constexpr std::array kEncoderParts{measure_files, compare_simplifiers, measure_bounds};

void run_mesh(const CaseContext& context, const EncoderMesh& mesh)
{
    for (const auto& run_part : kEncoderParts)
    {
        run_part({context, mesh});
    }
}

std::vector<Case> encoder_cases()
{
    std::vector<Case> cases;
    for (const EncoderMesh& mesh : all_meshes())
    {
        cases.push_back(make_case(mesh.name, mesh.when, run_mesh, mesh));
    }
    return cases;
}

} // namespace

Suite encoder_suite()
{
    return {"encoder", encoder_cases};
}

} // namespace tactus::bench
