// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/all_peers.hpp"

#include <btBulletCollisionCommon.h>
#include <limits>

namespace tactus::bench
{

namespace
{

constexpr double kDiagonal_units = 10.0;

double units_per_metre(const std::vector<test::Face>& faces)
{
    Vec3 low = to_vec3(faces[0][0]);
    Vec3 high = low;
    for (const test::Face& face : faces)
    {
        for (const Vec3f& corner : face)
        {
            low = low.cwiseMin(to_vec3(corner));
            high = high.cwiseMax(to_vec3(corner));
        }
    }
    return kDiagonal_units / (high - low).norm();
}

btVector3 to_bullet(const Vec3& units)
{
    return {static_cast<btScalar>(units.x()), static_cast<btScalar>(units.y()),
            static_cast<btScalar>(units.z())};
}

/// Keeps the contact with the least distance.
class NearestContact final : public btCollisionWorld::ContactResultCallback
{
public:
    explicit NearestContact(double threshold_units)
    {
        m_closestDistanceThreshold = static_cast<btScalar>(threshold_units);
    }

    btScalar addSingleResult(btManifoldPoint& contact, const btCollisionObjectWrapper* /*sphere*/,
                             int /*part*/, int /*index*/, const btCollisionObjectWrapper* /*mesh*/,
                             int /*mesh_part*/, int /*face*/) override
    {
        if (contact.getDistance() < distance)
        {
            distance = contact.getDistance();
            on_mesh = contact.getPositionWorldOnB();
        }
        return 0.0F;
    }

    btScalar distance{std::numeric_limits<btScalar>::infinity()};
    btVector3 on_mesh{0.0F, 0.0F, 0.0F};
};

class BulletQuery final : public TouchQuery
{
public:
    BulletQuery(const std::vector<test::Face>& faces, double radius_m)
        : units_per_metre_(units_per_metre(faces))
        , radius_m_(radius_m)
        , dispatcher_(&configuration_)
        , world_(&dispatcher_, &broadphase_, &configuration_)
        , sphere_(static_cast<btScalar>(radius_m * units_per_metre_))
    {
        triangles_.preallocateVertices(static_cast<int>(3 * faces.size()));
        triangles_.preallocateIndices(static_cast<int>(3 * faces.size()));
        for (const test::Face& face : faces)
        {
            triangles_.addTriangle(to_bullet(units_per_metre_ * to_vec3(face[0])),
                                   to_bullet(units_per_metre_ * to_vec3(face[1])),
                                   to_bullet(units_per_metre_ * to_vec3(face[2])));
        }
        mesh_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
        mesh_->setMargin(0.0F);
        mesh_object_.setCollisionShape(mesh_.get());
        probe_.setCollisionShape(&sphere_);
    }

    [[nodiscard]] std::string name() const override { return "Bullet"; }
    [[nodiscard]] bool needs_band() const override { return true; }
    [[nodiscard]] double distance_m(const Vec3& point_m, double band_m) override
    {
        probe_.getWorldTransform().setOrigin(to_bullet(units_per_metre_ * point_m));
        NearestContact nearest((band_m - radius_m_) * units_per_metre_);
        world_.contactPairTest(&probe_, &mesh_object_, nearest);
        const double distance_m =
            radius_m_ + static_cast<double>(nearest.distance) / units_per_metre_;
        if (!(distance_m < band_m))
        {
            return std::numeric_limits<double>::infinity();
        }
        const btVector3& on_mesh = nearest.on_mesh;
        nearest_m_ = to_vec3(Vec3f{on_mesh.x(), on_mesh.y(), on_mesh.z()}) / units_per_metre_;
        return distance_m;
    }
    [[nodiscard]] Vec3 nearest_m() const override { return nearest_m_; }

private:
    double units_per_metre_;
    double radius_m_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_;
    btTriangleMesh triangles_;
    std::unique_ptr<btBvhTriangleMeshShape> mesh_;
    btSphereShape sphere_;
    btCollisionObject mesh_object_;
    btCollisionObject probe_;
    Vec3 nearest_m_{0.0, 0.0, 0.0};
};

} // namespace

std::unique_ptr<TouchQuery> make_bullet_query(const std::vector<test::Face>& faces, double radius_m)
{
    return std::make_unique<BulletQuery>(faces, radius_m);
}

} // namespace tactus::bench
