// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Extraction against the source mesh: manifold, within the bound, face for face inside a zone.

#include "host_tools/encode/extract.hpp"
#include "host_tools/encode/zone.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/manifold.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace tactus
{
namespace
{

using Point = std::array<double, 3>;
/// Face by the positions of its corners, the least first: independent of ids.
using PlainFace = std::array<Point, 3>;

Vec3 to_vec(const Point& p)
{
    return {p[0], p[1], p[2]};
}

PlainFace turned(PlainFace face)
{
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

Point point_on(const PlainFace& face, double s, double t)
{
    Point p{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        p[axis] = (1.0 - s - t) * face[0][axis] + s * face[1][axis] + t * face[2][axis];
    }
    return p;
}

long double distance_to(const std::vector<PlainFace>& faces, const Point& point)
{
    long double least = std::numeric_limits<long double>::infinity();
    for (const PlainFace& face : faces)
    {
        least = std::min(least,
                         test::DistanceOracle::distance(
                             to_vec(point), {to_vec(face[0]), to_vec(face[1]), to_vec(face[2])}));
    }
    return least;
}

bool holds(const Zone& zone, const Point& point)
{
    const Vec3 p = to_vec(point);
    if (const auto* sphere = std::get_if<SphereZone>(&zone))
    {
        return (p - sphere->center_m).norm() <= sphere->radius_m;
    }
    const auto& box = std::get<BoxZone>(zone);
    return (p.array() >= box.low_m.array()).all() && (p.array() <= box.high_m.array()).all();
}

std::vector<PlainFace> faces_of(const TriangleMesh& mesh)
{
    std::vector<PlainFace> faces;
    for (const auto& [a, b, c] : mesh.faces)
    {
        faces.push_back(turned({mesh.positions[a], mesh.positions[b], mesh.positions[c]}));
    }
    return faces;
}

std::vector<PlainFace> source_faces(const EncodedModel& model)
{
    TriangleMesh mesh;
    mesh.faces = model.prepared.mesh.faces;
    for (const auto& position : model.prepared.mesh.positions)
    {
        Point& p = mesh.positions.emplace_back(model.prepared.origin_m);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            p[axis] += position[axis] * model.prepared.quantum_m;
        }
    }
    return faces_of(mesh);
}

long double sampled_distance(const EncodedModel& model, const TriangleMesh& mesh, int samples,
                             test::Random& random)
{
    const std::vector<PlainFace> source = source_faces(model);
    const std::vector<PlainFace> faces = faces_of(mesh);
    long double largest = 0.0L;
    for (int i = 0; i < samples; ++i)
    {
        const PlainFace& face = source[random.below(static_cast<std::uint32_t>(source.size()))];
        const double s = random.between(0.0, 1.0);
        const Point point =
            random.one_in(2) ? face[0] : point_on(face, s, random.between(0.0, 1.0 - s));
        largest = std::max(largest, distance_to(faces, point));
    }
    return largest;
}

bool reaches_into(const Zone& zone, const PlainFace& face)
{
    constexpr int kSteps = 8;
    for (int i = 0; i <= kSteps; ++i)
    {
        for (int k = 0; k <= kSteps - i; ++k)
        {
            if (holds(zone, point_on(face, i / double{kSteps}, k / double{kSteps})))
            {
                return true;
            }
        }
    }
    return false;
}

using test::Random;

std::unique_ptr<EncodedModel> encode(const std::string& name, const TriangleMesh& mesh)
{
    return encode_source(name, mesh, 60);
}

/// Models: smooth, sharp, open, of genus 1, with needles and poles, of two components, far from the
/// origin.
const std::vector<const EncodedModel*>& models()
{
    static const std::vector<std::unique_ptr<EncodedModel>> own = []
    {
        std::vector<std::unique_ptr<EncodedModel>> made;
        made.push_back(encode("torus", make_shape(Shape::torus, 3'000).value()));
        made.push_back(encode("needles", make_uv_sphere(10, 150).value()));
        TriangleMesh pair = make_shape(Shape::sphere, 1'000).value();
        const std::size_t vertices = pair.positions.size();
        const std::size_t faces = pair.faces.size();
        for (std::size_t i = 0; i < vertices; ++i)
        {
            const Point p = pair.positions[i];
            pair.positions.push_back({p[0] + 1'000.0, p[1] * 0.5, p[2]});
            pair.positions[i][0] += 999.8;
        }
        for (std::size_t i = 0; i < faces; ++i)
        {
            auto face = pair.faces[i];
            std::for_each(face.begin(), face.end(),
                          [&](std::uint32_t& corner)
                          { corner += static_cast<std::uint32_t>(vertices); });
            pair.faces.push_back(face);
        }
        made.push_back(encode("pair, far away", pair));
        return made;
    }();
    static const std::vector<const EncodedModel*> all = []
    {
        std::vector<const EncodedModel*> list;
        for (const auto* group : {&sample_models(), &own})
        {
            for (const auto& model : *group)
            {
                list.push_back(model.get());
            }
        }
        return list;
    }();
    return all;
}

/// Zone around a corner of the source, so that it always contains a part, from a few faces to a
/// third of it.
Zone random_zone(const EncodedModel& model, Random& random)
{
    const std::vector<PlainFace> source = source_faces(model);
    const Vec3 center = to_vec(source[random.below(static_cast<std::uint32_t>(source.size()))][0]) +
                        random.in_cube(0.02 * model.prepared.diagonal_m);
    const double size = random.between(0.03, 0.2) * model.prepared.diagonal_m;
    if (random.one_in(2))
    {
        return SphereZone{center, size};
    }
    return BoxZone{center - Vec3::Constant(size) + random.in_cube(0.5 * size),
                   center + Vec3::Constant(size) + random.in_cube(0.5 * size)};
}

/// Expects every source face with a point in the zone in the mesh, as often as in the source;
/// returns their number.
std::uint32_t expect_exact_in(const Zone& zone, const EncodedModel& model, const TriangleMesh& mesh)
{
    const std::vector<PlainFace> faces = faces_of(mesh);
    std::multiset<PlainFace> there(faces.begin(), faces.end());
    std::uint32_t inside = 0;
    std::uint32_t missing = 0;
    for (const PlainFace& face : source_faces(model))
    {
        if (reaches_into(zone, face))
        {
            ++inside;
            const auto found = there.find(face);
            missing += found == there.end() ? 1U : 0U;
            if (found != there.end())
            {
                there.erase(found);
            }
        }
    }
    EXPECT_EQ(missing, 0U);
    return inside;
}

/// Random combination of demands.
ExtractRequest random_request(const EncodedModel& model, Random& random)
{
    ExtractRequest request;
    const std::uint32_t kind = random.below(5);
    if (kind == 0 || kind == 3)
    {
        request.faces = random.below(model.fields.source_faces + 10);
    }
    if (kind == 1 || kind == 4)
    {
        request.error_m = model.prepared.diagonal_m * std::pow(10.0, random.between(-5.0, -1.5));
    }
    if (kind >= 2)
    {
        request.zone = random_zone(model, random);
    }
    return request;
}

void expect_manifold_cuts(const EncodedModel& model, int cuts, Random& random)
{
    SCOPED_TRACE(model.name);
    for (int i = 0; i < cuts; ++i)
    {
        const Extraction sut = extract(*model.decoded, random_request(model, random));
        EXPECT_EQ(test::manifold_fault(sut.mesh.faces), "") << "cut " << i;
        std::vector<bool> is_used(sut.mesh.positions.size());
        for (const auto& face : sut.mesh.faces)
        {
            for (const std::uint32_t vertex : face)
            {
                is_used[vertex] = true;
            }
        }
        EXPECT_EQ(std::ranges::count(is_used, false), 0) << "cut " << i;
    }
}

TEST(Extract, the_mesh_is_manifold_at_every_cut)
{
    Random random(1);
    for (const EncodedModel* model : models())
    {
        // A loose triangle that moves into another shares one of its edges.
        if (model->name != "soup")
        {
            expect_manifold_cuts(*model, 40, random);
        }
    }
}

TEST(Extract, well_known_meshes_give_manifolds)
{
    Random random(2);
    for (std::size_t i = 0; i < 3; ++i)
    {
        const auto mesh = test::read_known(test::kKnownMeshes[i]);
        if (!mesh)
        {
            GTEST_SKIP() << "TACTUS_MESHES is not set";
        }
        expect_manifold_cuts(*encode_source(test::kKnownMeshes[i].name, *mesh, 60), 20, random);
    }
}

TEST(Extract, every_source_face_in_the_zone_is_there_exactly)
{
    Random random(3);
    for (const EncodedModel* model : models())
    {
        SCOPED_TRACE(model->name);
        std::size_t coarse_ones = 0;
        for (int i = 0; i < 12; ++i)
        {
            const Zone zone = random_zone(*model, random);
            const Extraction sut = extract(*model->decoded, {{}, {}, zone});
            const std::uint32_t inside = expect_exact_in(zone, *model, sut.mesh);
            EXPECT_GE(sut.zone_faces, inside) << "zone " << i;
            coarse_ones += sut.mesh.faces.size() < model->fields.source_faces / 2 ? 1U : 0U;
        }
        if (model->fields.base_faces < model->fields.source_faces / 4)
        {
            EXPECT_GT(coarse_ones, 0U); // Not everything is fine.
        }
    }
}

TEST(Extract, no_point_of_the_source_is_farther_than_the_error_asked_for)
{
    Random random(4);
    for (const EncodedModel* model : models())
    {
        SCOPED_TRACE(model->name);
        std::size_t faces = std::numeric_limits<std::size_t>::max();
        for (const double share : {3e-4, 2e-3, 1e-2})
        {
            const double error_m = share * model->prepared.diagonal_m;
            const Extraction sut = extract(*model->decoded, {{}, error_m, {}});
            EXPECT_LE(sut.error_max_m, error_m);
            EXPECT_LE(sampled_distance(*model, sut.mesh, 250, random),
                      static_cast<long double>(sut.error_max_m + 1e-12));
            EXPECT_LE(sut.mesh.faces.size(), faces); // A larger error gives fewer faces.
            faces = sut.mesh.faces.size();
        }
    }
}

TEST(Extract, a_bound_that_is_half_as_large_would_be_caught)
{
    Random random(5);
    const EncodedModel& model = *sample_models()[1];
    const Extraction sut = extract(*model.decoded, {{}, 5e-3 * model.prepared.diagonal_m, {}});
    EXPECT_GT(sampled_distance(model, sut.mesh, 2'000, random),
              static_cast<long double>(0.5 * sut.error_max_m));
}

TEST(Extract, the_base_mesh_meets_its_own_bound_and_less_takes_a_split)
{
    for (const EncodedModel* model : models())
    {
        const double bound_m = extract(*model->decoded, {1, {}, {}}).error_max_m;
        const auto faces_at = [&](double error_m) {
            return extract(*model->decoded, {{}, error_m, {}}).mesh.faces.size();
        };
        EXPECT_EQ(faces_at(bound_m), model->fields.base_faces) << model->name;
        EXPECT_GT(faces_at(0.999 * bound_m), model->fields.base_faces) << model->name;
        EXPECT_LT(faces_at(0.999 * bound_m), model->fields.source_faces) << model->name;
    }
}

TEST(Extract, no_error_is_the_whole_source)
{
    for (const EncodedModel* model : models())
    {
        const Extraction sut = extract(*model->decoded, {{}, 0.0, {}});
        std::vector<PlainFace> faces = faces_of(sut.mesh);
        std::vector<PlainFace> source = source_faces(*model);
        std::sort(faces.begin(), faces.end());
        std::sort(source.begin(), source.end());
        EXPECT_EQ(faces, source) << model->name;
        EXPECT_EQ(sut.error_max_m, 0.0) << model->name;
    }
}

TEST(Extract, a_number_of_faces_is_kept_to_within_one_split)
{
    Random random(6);
    for (const EncodedModel* model : models())
    {
        const std::uint32_t base = model->fields.base_faces;
        const std::uint32_t source = model->fields.source_faces;
        for (int i = 0; i < 10; ++i)
        {
            const std::uint32_t wanted = base + random.below(source - base + 1);
            const std::size_t has = extract(*model->decoded, {wanted, {}, {}}).mesh.faces.size();
            EXPECT_LE(has, wanted) << model->name;
            EXPECT_GE(has + 1, wanted) << model->name;
        }
        EXPECT_EQ(extract(*model->decoded, {1, {}, {}}).mesh.faces.size(), base) << model->name;
        EXPECT_EQ(extract(*model->decoded, {source + 5, {}, {}}).mesh.faces.size(), source)
            << model->name;
    }
}

TEST(Extract, a_zone_and_an_error_hold_together)
{
    Random random(7);
    for (const EncodedModel* model : models())
    {
        SCOPED_TRACE(model->name);
        const Zone zone = random_zone(*model, random);
        const double error_m = 4e-3 * model->prepared.diagonal_m;
        const Extraction sut = extract(*model->decoded, {{}, error_m, zone});
        expect_exact_in(zone, *model, sut.mesh);
        EXPECT_LE(sut.error_max_m, error_m);
        EXPECT_LE(sampled_distance(*model, sut.mesh, 200, random),
                  static_cast<long double>(error_m + 1e-12));
    }
}

TEST(Extract, the_faces_beside_a_zone_fill_up_what_is_left)
{
    Random random(8);
    for (const EncodedModel* model : models())
    {
        SCOPED_TRACE(model->name);
        const Zone zone = random_zone(*model, random);
        const TriangleMesh least = extract(*model->decoded, {{}, {}, zone}).mesh;
        const auto needed = static_cast<std::uint32_t>(least.faces.size());
        const std::uint32_t wanted = needed + (model->fields.source_faces - needed) / 2;
        const TriangleMesh sut = extract(*model->decoded, {wanted, {}, zone}).mesh;
        expect_exact_in(zone, *model, sut);
        EXPECT_LE(sut.faces.size(), wanted);
        EXPECT_GE(sut.faces.size() + 1, wanted);
        // Too few faces: the zone gets its needs, and nothing else does.
        EXPECT_EQ(faces_of(extract(*model->decoded, {1, {}, zone}).mesh), faces_of(least));
    }
}

TEST(Extract, a_zone_beside_the_model_leaves_the_base_mesh)
{
    const EncodedModel& model = *sample_models()[1];
    const Extraction sut =
        extract(*model.decoded, {{}, {}, SphereZone{Vec3(100.0, 0.0, 0.0), 1.0}});
    EXPECT_EQ(sut.zone_faces, 0U);
    EXPECT_EQ(sut.mesh.faces.size(), model.fields.base_faces);
}

} // namespace
} // namespace tactus
