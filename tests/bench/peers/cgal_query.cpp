// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/all_peers.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <cmath>

namespace tactus::bench
{

namespace
{

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Vec3f& point)
{
    const Vec3 wide = to_vec3(point);
    return {wide.x(), wide.y(), wide.z()};
}

Triangles to_cgal(const std::vector<test::Face>& faces)
{
    Triangles triangles;
    triangles.reserve(faces.size());
    for (const test::Face& face : faces)
    {
        triangles.emplace_back(to_cgal(face[0]), to_cgal(face[1]), to_cgal(face[2]));
    }
    return triangles;
}

class CgalQuery final : public TouchQuery
{
public:
    explicit CgalQuery(const std::vector<test::Face>& faces)
        : triangles_(to_cgal(faces))
        , tree_(triangles_.cbegin(), triangles_.cend())
        , hint_(triangles_.front()[0])
    {
        tree_.build();
    }

    [[nodiscard]] std::string name() const override { return "CGAL"; }
    [[nodiscard]] double distance_m(const Vec3& point_m, double /*band_m*/) override
    {
        const Kernel::Point_3 point(point_m.x(), point_m.y(), point_m.z());
        hint_ = tree_.closest_point(point, hint_);
        return std::sqrt(CGAL::squared_distance(point, hint_));
    }
    [[nodiscard]] Vec3 nearest_m() const override { return {hint_.x(), hint_.y(), hint_.z()}; }
    void forget() override { hint_ = triangles_.front()[0]; }

private:
    Triangles triangles_;
    Tree tree_;
    Kernel::Point_3 hint_; ///< The last answer.
};

} // namespace

std::unique_ptr<TouchQuery> make_cgal_query(const std::vector<test::Face>& faces,
                                            double /*radius_m*/)
{
    return std::make_unique<CgalQuery>(faces);
}

} // namespace tactus::bench
