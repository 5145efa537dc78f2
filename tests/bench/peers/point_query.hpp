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

/// A contestant that is judged by more than its time. What knows no band answers beyond it, too.
class TouchQuery : public PointQuery
{
public:
    /// Where on the surface the last answer that was finite has its nearest point.
    [[nodiscard]] virtual Vec3 nearest_m() const = 0;
    /// Drops what is kept of earlier questions: the next one is asked as the first one was.
    virtual void forget() {}
    /// True: it has to be asked with a finite band, without one it would look at every face.
    [[nodiscard]] virtual bool needs_band() const { return false; }
    /// What it holds by its own account; none: what the heap has grown by is all.
    [[nodiscard]] virtual std::optional<std::size_t> own_bytes() const { return std::nullopt; }
};

/// A peer that this build was configured with (TACTUS_BENCH_PEERS).
struct PointPeer
{
    std::string name;
    /// Builds it over the whole mesh, for a probe of this radius; `faces` must outlive it. Throws
    /// std::runtime_error when the peer refuses the mesh.
    std::unique_ptr<TouchQuery> (*make)(const std::vector<test::Face>& faces, double radius_m);
    std::size_t most_faces{static_cast<std::size_t>(-1)}; ///< Over more it is left out,
    const char* why_no_more{""};                          ///< and this is said.
};
[[nodiscard]] std::vector<PointPeer> point_peers();

/// The peers whose times are the goals of other suites, over the whole mesh, as PointPeer::make
/// has it: Embree, if it was configured.
[[nodiscard]] std::vector<std::unique_ptr<PointQuery>>
make_peers(const std::vector<test::Face>& faces);

} // namespace tactus::bench
