// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/all_peers.hpp"

namespace tactus::bench
{

std::vector<PointPeer> point_peers()
{
    return {
#ifdef TACTUS_BENCH_EMBREE
        {"Embree", make_embree_query},
#endif
#ifdef TACTUS_BENCH_CGAL
        {"CGAL", make_cgal_query},
#endif
#ifdef TACTUS_BENCH_FCL
        {"FCL, point", make_fcl_query},
        {"FCL, sphere", make_fcl_sphere_query, 1'000'000,
         "a query in flight takes 1.2 ms at 400 k already"},
#endif
#ifdef TACTUS_BENCH_BULLET
        {"Bullet", make_bullet_query, (std::size_t{1} << 21U) - 1,
         "its nodes number triangles with 21 bits"},
#endif
    };
}

std::vector<std::unique_ptr<PointQuery>>
make_peers([[maybe_unused]] const std::vector<test::Face>& faces)
{
    std::vector<std::unique_ptr<PointQuery>> peers;
#ifdef TACTUS_BENCH_EMBREE
    peers.push_back(make_embree_query(faces, 0.0));
#endif
    return peers;
}

std::vector<PairPeer> pair_peers()
{
    return {
#ifdef TACTUS_BENCH_FCL
        {"FCL", make_fcl_pair_query},
#endif
    };
}

std::vector<MeshSimplifier> mesh_simplifiers()
{
    return {
#ifdef TACTUS_BENCH_CGAL
        {kGarlandHeckbert, simplify_by_garland_heckbert},
        {"CGAL Garland-Heckbert, bounded normals", simplify_by_bounded_garland_heckbert},
        {"CGAL Lindstrom-Turk", simplify_by_lindstrom_turk},
#endif
#ifdef TACTUS_BENCH_OPENMESH
        {"OpenMesh", simplify_by_openmesh},
#endif
#ifdef TACTUS_BENCH_MESHOPTIMIZER
        {kMeshoptimizer, simplify_by_meshoptimizer},
#endif
    };
}

} // namespace tactus::bench
