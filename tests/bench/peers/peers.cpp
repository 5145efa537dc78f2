// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/peers/point_query.hpp"

#ifdef TACTUS_BENCH_EMBREE
#include "tests/bench/peers/embree_query.hpp"
#endif

namespace tactus::bench
{

std::vector<std::unique_ptr<PointQuery>>
make_peers([[maybe_unused]] const std::vector<test::Face>& faces)
{
    std::vector<std::unique_ptr<PointQuery>> peers;
#ifdef TACTUS_BENCH_EMBREE
    peers.push_back(make_embree_query(faces));
#endif
    return peers;
}

} // namespace tactus::bench
