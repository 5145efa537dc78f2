// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/shared/brute_force.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Peers of this build; each is defined where its library is configured.
namespace tactus::bench
{

struct SimplifiedMesh
{
    TriangleMesh mesh; ///< Mesh in quanta; may have vertices that no face uses.
    double seconds{0.0};
};

/// Library that simplifies with its defaults, on one thread.
struct MeshSimplifier
{
    std::string name;
    /// Simplifies to `faces` faces or the nearest number that the library reaches. The time is that
    /// of the library's own call; conversions of meshes are not included, in its favour.
    SimplifiedMesh (*simplify)(const QuantisedMesh& mesh, std::uint32_t faces);
};

/// Names of the peers that goals refer to.
inline constexpr const char* kGarlandHeckbert = "CGAL Garland-Heckbert";
inline constexpr const char* kMeshoptimizer = "meshoptimizer";

/// Configured peers (TACTUS_BENCH_PEERS) that simplify. They throw std::runtime_error if they
/// refuse a mesh.
[[nodiscard]] std::vector<MeshSimplifier> mesh_simplifiers();

/// Questions about two meshes, one of them moving, for every contestant. Each time includes one
/// virtual call.
class PairQuery
{
public:
    PairQuery() = default;
    PairQuery(const PairQuery&) = delete;
    PairQuery& operator=(const PairQuery&) = delete;
    virtual ~PairQuery() = default;

    [[nodiscard]] virtual std::string name() const = 0;
    /// Sets the pose of the tool's frame in the object's, with scale 1. Not timed.
    virtual void place(const Similarity& tool) = 0;

    /// True if any two faces share a point.
    [[nodiscard]] virtual bool do_meet() = 0;
    /// All pairs of meeting faces in any order, with the contestant's own names; valid until the
    /// next question.
    [[nodiscard]] virtual const std::vector<test::FacePair>& meeting() = 0;
    /// The same with points of contact, as far as the contestant keeps them.
    [[nodiscard]] virtual const std::vector<test::FacePair>& contacts() = 0;
    /// Least distance of two faces; 0 if some meet.
    [[nodiscard]] virtual double distance_m() = 0;

    /// Places of a pair in the source lists. Not timed.
    [[nodiscard]] virtual test::FacePair in_source(const test::FacePair& own) const { return own; }
    /// Drops the memory of earlier questions.
    virtual void forget() {}
};

/// Triangles in the tool's frame and in the object's.
struct PairMeshes
{
    std::vector<Triangle> tool;
    std::vector<Triangle> object;
};

/// Peer that this build was configured with (TACTUS_BENCH_PEERS).
struct PairPeer
{
    std::string name;
    std::unique_ptr<PairQuery> (*make)(const PairMeshes& meshes);
};
[[nodiscard]] std::vector<PairPeer> pair_peers();

/// Distance question for every contestant. Each time includes one virtual call.
class PointQuery
{
public:
    PointQuery() = default;
    PointQuery(const PointQuery&) = delete;
    PointQuery& operator=(const PointQuery&) = delete;
    virtual ~PointQuery() = default;

    [[nodiscard]] virtual std::string name() const = 0;
    /// Distance to the nearest face; infinity when none is within `band_m`, which may be infinite.
    [[nodiscard]] virtual double distance_m(const Vec3& point_m, double band_m) = 0;
};

/// Contestant that is judged by more than its time. One without a band also answers beyond it.
class TouchQuery : public PointQuery
{
public:
    /// Nearest point on the surface of the last finite answer.
    [[nodiscard]] virtual Vec3 nearest_m() const = 0;
    /// Drops the memory of earlier questions, so that the next one is as the first.
    virtual void forget() {}
    /// True if a finite band is required; without one every face would be tested.
    [[nodiscard]] virtual bool needs_band() const { return false; }
    /// Memory by the contestant's own account; empty: the growth of the heap is all.
    [[nodiscard]] virtual std::optional<std::size_t> own_bytes() const { return std::nullopt; }
};

/// Peer that this build was configured with (TACTUS_BENCH_PEERS).
struct PointPeer
{
    std::string name;
    /// Builds the peer over the whole mesh, for a sphere of this radius; `faces` must outlive it.
    /// Throws std::runtime_error if the peer refuses the mesh.
    std::unique_ptr<TouchQuery> (*make)(const std::vector<test::Face>& faces, double radius_m);
    /// Greatest number of faces; the peer is skipped above it.
    std::size_t most_faces{static_cast<std::size_t>(-1)};
    const char* why_no_more{""}; ///< Printed reason for the skip.
};
[[nodiscard]] std::vector<PointPeer> point_peers();

/// Peers whose times are goals of other suites, over the whole mesh, see PointPeer::make: Embree,
/// if configured.
[[nodiscard]] std::vector<std::unique_ptr<PointQuery>>
make_peers(const std::vector<test::Face>& faces);

/// Bullet's contactPairTest() of a sphere with a btBvhTriangleMeshShape (quantised boxes, the usual
/// choice), asked for contacts within the band; returns the least distance. The mesh is in float,
/// scaled to a diagonal of 10, since Bullet's tolerances are for objects of some units. Without a
/// band, every triangle would be tested.
[[nodiscard]] std::unique_ptr<TouchQuery> make_bullet_query(const std::vector<test::Face>& faces,
                                                            double radius_m);

/// CGAL's AABB_tree of triangles in double precision, Simple_cartesian<double>. The hint for the
/// closest point is the last answer's, the first corner for the first question. No band.
[[nodiscard]] std::unique_ptr<TouchQuery> make_cgal_query(const std::vector<test::Face>& faces,
                                                          double radius_m);

/// CGAL's edge_collapse over a Surface_mesh in double, with cost and placement by the plane
/// quadrics of Garland and Heckbert only.
[[nodiscard]] SimplifiedMesh simplify_by_garland_heckbert(const QuantisedMesh& mesh,
                                                          std::uint32_t faces);

/// The same without collapses that turn a face's normal too far, as in CGAL's example.
[[nodiscard]] SimplifiedMesh simplify_by_bounded_garland_heckbert(const QuantisedMesh& mesh,
                                                                  std::uint32_t faces);

/// The same with cost and placement of Lindstrom and Turk, CGAL's default.
[[nodiscard]] SimplifiedMesh simplify_by_lindstrom_turk(const QuantisedMesh& mesh,
                                                        std::uint32_t faces);

/// Embree's point query (rtcPointQuery) over a scene of triangles with separate corners, built at
/// high quality by one thread, in float. Its memory is that of its device's monitor, since the heap
/// counts only a part.
[[nodiscard]] std::unique_ptr<TouchQuery> make_embree_query(const std::vector<test::Face>& faces,
                                                            double radius_m);

/// FCL's distance between a BVHModel<OBBRSS<double>> and a sphere without a radius. No band.
[[nodiscard]] std::unique_ptr<TouchQuery> make_fcl_query(const std::vector<test::Face>& faces,
                                                         double radius_m);

/// The same with a sphere of the probe's radius: collide() reports a touch and the greatest depth
/// of all contacts, distance() the gap otherwise (about 0, of either sign, if they overlap). The
/// radius is added to obtain the distance of the centre.
[[nodiscard]] std::unique_ptr<TouchQuery>
make_fcl_sphere_query(const std::vector<test::Face>& faces, double radius_m);

/// FCL's collide() and distance() of two BVHModel<OBBRSS<double>>.
[[nodiscard]] std::unique_ptr<PairQuery> make_fcl_pair_query(const PairMeshes& meshes);

/// meshopt_simplify without a bound on the error: an index list over unchanged vertices.
[[nodiscard]] SimplifiedMesh simplify_by_meshoptimizer(const QuantisedMesh& mesh,
                                                       std::uint32_t faces);

/// OpenMesh's decimater with its quadric module only, over its default triangle mesh in float:
/// half-edge collapses, no bound on the error.
[[nodiscard]] SimplifiedMesh simplify_by_openmesh(const QuantisedMesh& mesh, std::uint32_t faces);

} // namespace tactus::bench
