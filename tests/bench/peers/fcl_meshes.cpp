// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/fcl_meshes.hpp"

#include <cmath>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <limits>
#include <optional>
#include <stdexcept>

namespace tactus::bench::fcl_meshes
{

namespace
{

constexpr std::size_t kAllContacts = std::numeric_limits<std::int32_t>::max();

fcl::Vector3d to_fcl(const Point& point)
{
    return {point[0], point[1], point[2]};
}

Point from_fcl(const fcl::Vector3d& point)
{
    return {point.x(), point.y(), point.z()};
}

fcl::Transform3d to_fcl(const Place& place)
{
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    for (Eigen::Index column = 0; column < 3; ++column)
    {
        for (Eigen::Index row = 0; row < 3; ++row)
        {
            transform.linear()(row, column) =
                place.rotation[static_cast<std::size_t>(3 * column + row)];
        }
    }
    transform.translation() = to_fcl(place.origin);
    return transform;
}

const fcl::Transform3d& nowhere_else()
{
    static const fcl::Transform3d identity = fcl::Transform3d::Identity();
    return identity;
}

} // namespace

struct Mesh::Content
{
    fcl::BVHModel<fcl::OBBRSSd> model;

    /// Deepest of all contacts; empty if nothing touches. FCL reports depths of spheres in
    /// triangles as negative numbers.
    [[nodiscard]] std::optional<Nearest> deepest(const fcl::Sphered& sphere,
                                                 const fcl::Transform3d& place) const
    {
        fcl::CollisionResultd result;
        fcl::collide(&model, nowhere_else(), &sphere, place,
                     fcl::CollisionRequestd(kAllContacts, true), result);
        std::optional<Nearest> deepest;
        for (std::size_t i = 0; i < result.numContacts(); ++i)
        {
            const fcl::Contactd& contact = result.getContact(i);
            const double distance = -std::abs(contact.penetration_depth);
            if (!deepest || distance < deepest->distance)
            {
                deepest = {distance, from_fcl(contact.pos)};
            }
        }
        return deepest;
    }
};

Mesh::Mesh(std::span<const std::array<Point, 3>> faces) : content_(std::make_unique<Content>())
{
    fcl::BVHModel<fcl::OBBRSSd>& model = content_->model;
    bool is_taken = model.beginModel(static_cast<int>(faces.size()),
                                     static_cast<int>(3 * faces.size())) == fcl::BVH_OK;
    for (const auto& [a, b, c] : faces)
    {
        is_taken = is_taken && model.addTriangle(to_fcl(a), to_fcl(b), to_fcl(c)) == fcl::BVH_OK;
    }
    if (!is_taken || model.endModel() != fcl::BVH_OK)
    {
        throw std::runtime_error("FCL: refuses the mesh");
    }
}

Mesh::~Mesh() = default;

Nearest Mesh::nearest_to_sphere(const Point& center, double radius) const
{
    const fcl::Sphered sphere(radius);
    fcl::Transform3d place = fcl::Transform3d::Identity();
    place.translation() = to_fcl(center);
    if (radius > 0.0)
    {
        if (const auto deepest = content_->deepest(sphere, place))
        {
            return *deepest;
        }
    }
    fcl::DistanceResultd result;
    const double distance = fcl::distance(&content_->model, nowhere_else(), &sphere, place,
                                          fcl::DistanceRequestd(true), result);
    return {distance, from_fcl(result.nearest_points[0])};
}

bool Mesh::does_meet(const Place& place, const Mesh& other) const
{
    fcl::CollisionResultd result;
    return fcl::collide(&content_->model, to_fcl(place), &other.content_->model, nowhere_else(),
                        fcl::CollisionRequestd(1, false), result) > 0;
}

void Mesh::find_meeting(const Place& place, const Mesh& other, bool with_contacts,
                        std::vector<std::array<std::uint32_t, 2>>& pairs) const
{
    fcl::CollisionResultd result;
    fcl::collide(&content_->model, to_fcl(place), &other.content_->model, nowhere_else(),
                 fcl::CollisionRequestd(kAllContacts, with_contacts), result);
    pairs.clear();
    for (std::size_t i = 0; i < result.numContacts(); ++i)
    {
        const fcl::Contactd& contact = result.getContact(i);
        pairs.push_back(
            {static_cast<std::uint32_t>(contact.b1), static_cast<std::uint32_t>(contact.b2)});
    }
}

double Mesh::distance_to(const Place& place, const Mesh& other) const
{
    fcl::DistanceResultd result;
    return fcl::distance(&content_->model, to_fcl(place), &other.content_->model, nowhere_else(),
                         fcl::DistanceRequestd(true), result);
}

} // namespace tactus::bench::fcl_meshes
