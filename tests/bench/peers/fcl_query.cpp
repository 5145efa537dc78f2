// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/all_peers.hpp"
#include "tests/bench/peers/fcl_meshes.hpp"

#include <algorithm>

namespace tactus::bench
{

namespace
{

using FclFaces = std::vector<std::array<fcl_meshes::Point, 3>>;

fcl_meshes::Point to_point(const Vec3& point)
{
    return {point.x(), point.y(), point.z()};
}

template <typename Corners>
FclFaces to_fcl(const std::vector<Corners>& faces)
{
    FclFaces result;
    result.reserve(faces.size());
    for (const auto& [a, b, c] : faces)
    {
        result.push_back({to_point(a), to_point(b), to_point(c)});
    }
    return result;
}

FclFaces widened(const std::vector<test::Face>& faces)
{
    std::vector<Triangle> triangles;
    triangles.reserve(faces.size());
    std::ranges::transform(faces, std::back_inserter(triangles), to_triangle);
    return to_fcl(triangles);
}

class FclQuery final : public TouchQuery
{
public:
    FclQuery(const std::vector<test::Face>& faces, double radius_m, std::string name)
        : name_(std::move(name)), mesh_(widened(faces)), radius_m_(radius_m)
    {
    }

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] double distance_m(const Vec3& point_m, double /*band_m*/) override
    {
        nearest_ = mesh_.nearest_to_sphere(to_point(point_m), radius_m_);
        return radius_m_ + nearest_.distance;
    }
    [[nodiscard]] Vec3 nearest_m() const override
    {
        return {nearest_.on_mesh[0], nearest_.on_mesh[1], nearest_.on_mesh[2]};
    }

private:
    std::string name_;
    fcl_meshes::Mesh mesh_;
    double radius_m_;
    fcl_meshes::Nearest nearest_;
};

class FclPairQuery final : public PairQuery
{
public:
    explicit FclPairQuery(const PairMeshes& meshes)
        : tool_(to_fcl(meshes.tool)), object_(to_fcl(meshes.object))
    {
    }

    [[nodiscard]] std::string name() const override { return "FCL"; }
    void place(const Similarity& tool) override
    {
        std::copy_n(tool.rotation.data(), place_.rotation.size(), place_.rotation.begin());
        place_.origin = to_point(tool.translation_m);
    }

    [[nodiscard]] bool do_meet() override { return tool_.does_meet(place_, object_); }
    [[nodiscard]] const std::vector<test::FacePair>& meeting() override { return find(false); }
    [[nodiscard]] const std::vector<test::FacePair>& contacts() override { return find(true); }
    [[nodiscard]] double distance_m() override
    {
        return std::max(tool_.distance_to(place_, object_), 0.0);
    }

private:
    const std::vector<test::FacePair>& find(bool with_contacts)
    {
        tool_.find_meeting(place_, object_, with_contacts, found_);
        pairs_.clear();
        for (const auto& [tool_face, face] : found_)
        {
            pairs_.push_back({tool_face, face});
        }
        return pairs_;
    }

    fcl_meshes::Mesh tool_;
    fcl_meshes::Mesh object_;
    fcl_meshes::Place place_;
    std::vector<std::array<std::uint32_t, 2>> found_;
    std::vector<test::FacePair> pairs_;
};

} // namespace

std::unique_ptr<TouchQuery> make_fcl_query(const std::vector<test::Face>& faces,
                                           double /*radius_m*/)
{
    return std::make_unique<FclQuery>(faces, 0.0, "FCL, point");
}

std::unique_ptr<TouchQuery> make_fcl_sphere_query(const std::vector<test::Face>& faces,
                                                  double radius_m)
{
    return std::make_unique<FclQuery>(faces, radius_m, "FCL, sphere");
}

std::unique_ptr<PairQuery> make_fcl_pair_query(const PairMeshes& meshes)
{
    return std::make_unique<FclPairQuery>(meshes);
}

} // namespace tactus::bench
