// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/math/triangle.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::bench
{

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

} // namespace tactus::bench
