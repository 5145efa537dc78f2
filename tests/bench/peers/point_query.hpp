// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/brute_force.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::bench
{

/// The distance question as every contestant answers it. One virtual call is in each one's time.
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

/// The peers that this build was configured with (TACTUS_BENCH_PEERS), each over the whole mesh;
/// `faces` must outlive them. Throws std::runtime_error when a peer refuses the mesh.
[[nodiscard]] std::vector<std::unique_ptr<PointQuery>>
make_peers(const std::vector<test::Face>& faces);

} // namespace tactus::bench
