// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/block.hpp"
#include "rt_core/abtree/node.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/query/probe.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace tactus::test
{

/// Input of the kernels: a block of 16 faces, a node's boxes and a probe.
struct KernelScene
{
    const char* shape{nullptr};
    const char* place{nullptr};
    float quantum_m{1.0F};
    BlockGeometry block;
    AabbVolume::Rows boxes;
    Vec3 point_m{0.0, 0.0, 0.0};
    KernelProbe probe{};

    [[nodiscard]] const float* coordinates() const { return block.coordinates.front().data(); }
    [[nodiscard]] const std::uint8_t* corners() const { return block.corners.front().data(); }
    [[nodiscard]] const float* box_rows() const { return boxes.low.front().data(); }
};

/// Corners in quanta; `size` is roughly half the edge of their cube.
using QuantaTriangle = std::array<Vec3, 3>;

/// Share of the length for triangles of aspects from about 10 to above 1e8.
[[nodiscard]] inline double thin_share(Random& random)
{
    return std::exp2(-random.between(3.0, 28.0));
}

struct FaceShape
{
    const char* name;
    QuantaTriangle (*make)(Random& random, double size);
};

[[nodiscard]] inline const std::array<FaceShape, 6>& face_shapes()
{
    static const std::array<FaceShape, 6> shapes{
        {{"plain",
          [](Random& random, double size) {
              return QuantaTriangle{random.in_cube(size), random.in_cube(size),
                                    random.in_cube(size)};
          }},
         {"needle",
          [](Random& random, double size)
          {
              const Vec3 a = random.in_cube(size);
              const Vec3 b = random.in_cube(size);
              return QuantaTriangle{a, b, a + random.in_cube(size * thin_share(random))};
          }},
         {"cap",
          [](Random& random, double size)
          {
              const Vec3 a = random.in_cube(size);
              const Vec3 b = random.in_cube(size);
              const double t = random.between(0.2, 0.8);
              return QuantaTriangle{a, b,
                                    a + t * (b - a) + random.in_cube(size * thin_share(random))};
          }},
         {"two equal corners",
          [](Random& random, double size)
          {
              const Vec3 a = random.in_cube(size);
              return QuantaTriangle{a, random.in_cube(size), a};
          }},
         {"three equal corners",
          [](Random& random, double size)
          {
              const Vec3 a = random.in_cube(size);
              return QuantaTriangle{a, a, a};
          }},
         {"collinear", [](Random& random, double size)
          {
              Vec3 a = random.in_cube(size);
              Vec3 step = random.in_cube(size / 4.0);
              for (int axis = 0; axis < 3; ++axis) // Whole numbers: exactly collinear.
              {
                  a[axis] = std::round(a[axis]);
                  step[axis] = std::round(step[axis]);
              }
              return QuantaTriangle{a, a + 3.0 * step, a + step};
          }}}};
    return shapes;
}

/// Place of a probe relative to a face, in metres.
struct ProbePlace
{
    const char* name;
    Vec3 (*make)(Random& random, const QuantaTriangle& face, double size);
};

[[nodiscard]] inline const std::array<ProbePlace, 6>& probe_places()
{
    static const auto between_corners = [](Random& random, const QuantaTriangle& face, double out)
    {
        const double s = random.between(-out, 1.0 + out);
        const double t = random.between(-out, 1.0 + out) * (1.0 - s);
        return Vec3(face[0] + s * (face[1] - face[0]) + t * (face[2] - face[0]));
    };
    static const std::array<ProbePlace, 6> places{
        {{"around", [](Random& random, const QuantaTriangle& /*face*/, double size)
          { return Vec3(random.in_cube(1.5 * size)); }},
         {"far",
          [](Random& random, const QuantaTriangle& /*face*/, double size)
          {
              const double most = 0x1p36 / size; // Coordinates stay within the kernels' range.
              return Vec3(random.in_cube(size * std::pow(most, random.between(0.1, 0.99))));
          }},
         {"on a corner", [](Random& random, const QuantaTriangle& face, double /*size*/)
          { return face[random.below(3)]; }},
         {"on an edge",
          [](Random& random, const QuantaTriangle& face, double /*size*/)
          {
              const std::uint32_t i = random.below(3);
              return Vec3(face[i] + random.between(-0.1, 1.1) * (face[(i + 1) % 3] - face[i]));
          }},
         {"grazing", [](Random& random, const QuantaTriangle& face, double /*size*/)
          { return between_corners(random, face, 0.5); }},
         {"just above", [](Random& random, const QuantaTriangle& face, double size)
          {
              const Vec3 over = between_corners(random, face, 0.05);
              return Vec3(over + random.in_cube(size * thin_share(random)));
          }}}};
    return places;
}

/// Five faces of the shape, and eleven more over their 15 vertices; the 16th row is NaN and unused.
[[nodiscard]] inline BlockGeometry block_of(Random& random, const FaceShape& shape, double size,
                                            bool whole, float quantum_m)
{
    BlockGeometry block;
    for (std::size_t row = 0; row < 15; row += 3)
    {
        const QuantaTriangle face = shape.make(random, size);
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const double at = face[corner][static_cast<Eigen::Index>(axis)];
                // Minus zero is avoided, as in models: sets may differ in the sign of a zero bound.
                block.coordinates[axis][row + corner] =
                    static_cast<float>(whole ? std::round(at) : at) * quantum_m + 0.0F;
            }
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        block.coordinates[axis][15] = std::numeric_limits<float>::quiet_NaN();
    }
    for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
    {
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t row = lane < 5 ? 3 * lane + corner : random.below(15);
            block.corners[corner][lane] = static_cast<std::uint8_t>(row);
        }
    }
    block.faces = 0xFFFF;
    block.vertices = 0x7FFF;
    return block;
}

/// Boxes of up to 15 of the block's vertices each: from points to the whole.
[[nodiscard]] inline AabbVolume::Rows boxes_in(Random& random, const BlockGeometry& block)
{
    AabbVolume::Rows rows;
    for (std::uint32_t child = 0; child < kNodeChildren; ++child)
    {
        Aabb box;
        for (std::uint32_t i = 0; i <= child; ++i)
        {
            const std::size_t row = random.below(15);
            box.add(Vec3f{block.coordinates[0][row], block.coordinates[1][row],
                          block.coordinates[2][row]});
        }
        rows.set(child, box);
    }
    return rows;
}

[[nodiscard]] inline KernelScene make_scene(Random& random, const FaceShape& shape,
                                            const ProbePlace& place)
{
    KernelScene scene;
    scene.shape = shape.name;
    scene.place = place.name;
    scene.quantum_m = static_cast<float>(std::exp2(std::round(random.between(-40.0, 6.0))));
    const double size = std::exp2(random.between(1.0, 23.0));
    scene.block = block_of(random, shape, size, random.one_in(2), scene.quantum_m);
    scene.boxes = boxes_in(random, scene.block);
    QuantaTriangle face;
    const auto corners = block_triangle(scene.block, random.below(5));
    for (std::size_t i = 0; i < 3; ++i)
    {
        face[i] = to_vec3(corners[i]) / static_cast<double>(scene.quantum_m);
    }
    scene.point_m = place.make(random, face, size) * static_cast<double>(scene.quantum_m);
    scene.probe = make_probe(scene.point_m, scene.quantum_m);
    return scene;
}

/// `rounds` scenes of each shape and place.
[[nodiscard]] inline std::vector<KernelScene> scenes(Random& random, int rounds)
{
    std::vector<KernelScene> all;
    for (const FaceShape& shape : face_shapes())
    {
        for (const ProbePlace& place : probe_places())
        {
            for (int round = 0; round < rounds; ++round)
            {
                all.push_back(make_scene(random, shape, place));
            }
        }
    }
    return all;
}

/// Expects the same result of `ask` for every set of kernels as for the portable one, to the last
/// bit.
template <typename Ask>
void expect_same_of_every_set(const KernelScene& scene, const Ask& ask)
{
    const auto expected = ask(portable_kernels());
    for (const Kernels* kernels : available_kernels())
    {
        ASSERT_EQ(ask(*kernels), expected)
            << kernels->name << ": " << scene.shape << ", probe " << scene.place;
    }
}

[[nodiscard]] inline std::uint32_t bits_of(float value)
{
    return std::bit_cast<std::uint32_t>(value);
}

/// None, all, some, or those below a lane.
[[nodiscard]] inline std::uint32_t random_mask(Random& random, std::uint32_t lanes)
{
    const std::uint32_t all = (1U << lanes) - 1;
    const std::array<std::uint32_t, 4> masks{0, all, random.below(all + 1),
                                             (1U << random.below(lanes + 1)) - 1};
    return masks[random.below(4)];
}

} // namespace tactus::test
