// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/inside_test.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{
namespace
{

/// Queries by places of the source mesh.
struct InsideRig
{
    InsideRig(const std::string& name, const TriangleMesh& mesh)
        : served_(serve_from_file(test_model(name, mesh, 2'000).path, name, {}).value())
        , header_(ModelHeader::parse(served_.header).value())
        , sut_(header_, served_.base)
    {
    }
    /// Distance from the surface beyond which the answer is right.
    [[nodiscard]] double sure_m() const
    {
        return 2.0 * static_cast<double>(header_.quantum_m()) * header_.fields().max_error_quanta;
    }
    [[nodiscard]] bool holds(const Vec3& source_m) const
    {
        return sut_.holds(source_m - header_.origin_m());
    }

private:
    ServedModel served_;
    ModelHeader header_;
    InsideTest sut_;
};

/// The oracle is the shape's formula.
TEST(InsideTest, knows_the_inside_of_a_torus_from_its_hole)
{
    constexpr double kRing_m = 0.05;
    constexpr double kTube_m = 0.02;
    const InsideRig rig("inside_torus", make_shape(Shape::torus, 5'000).value());
    Random random(481);
    int inside = 0;
    for (int i = 0; i < 2'000; ++i)
    {
        const Vec3 place_m = random.in_cube(0.09);
        const double off_ring_m =
            std::hypot(std::hypot(place_m.x(), place_m.y()) - kRing_m, place_m.z());
        if (std::abs(off_ring_m - kTube_m) < rig.sure_m())
        {
            continue;
        }
        inside += off_ring_m < kTube_m ? 1 : 0;
        EXPECT_EQ(rig.holds(place_m), off_ring_m < kTube_m) << place_m.transpose();
    }
    EXPECT_LT(rig.sure_m(), 0.5 * kTube_m);
    EXPECT_GT(inside, 10);
}

TEST(InsideTest, finds_nothing_inside_an_open_mesh)
{
    const InsideRig rig("inside_terrain", make_shape(Shape::terrain, 2'000).value());
    for (const double height_m : {-0.01, 0.0, 0.005, 0.02})
    {
        EXPECT_FALSE(rig.holds(Vec3(0.0, 0.0, height_m)));
    }
}

TEST(InsideTest, finds_nothing_inside_a_model_whose_base_mesh_is_not_here)
{
    const TestModel& model = test_model("inside_sphere", make_shape(Shape::sphere, 2'000).value());
    const ServedModel served = serve_from_file(model.path, "ball", {}).value();
    const ModelHeader header = ModelHeader::parse(served.header).value();
    const Vec3 middle_m = -header.origin_m();
    EXPECT_TRUE(InsideTest(header, served.base).holds(middle_m));
    EXPECT_FALSE(InsideTest(header, {}).holds(middle_m));
}

} // namespace
} // namespace tactus::test
