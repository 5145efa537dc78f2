// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/brute_force.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench
{

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

} // namespace tactus::bench
