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

/// Two meshes, one of them moving: the questions as every contestant answers them. One
/// virtual call is in each one's time.
class PairQuery
{
public:
    PairQuery() = default;
    PairQuery(const PairQuery&) = delete;
    PairQuery& operator=(const PairQuery&) = delete;
    virtual ~PairQuery() = default;

    [[nodiscard]] virtual std::string name() const = 0;
    /// From here on the tool's frame lies so in the object's; of scale 1. Not timed.
    virtual void place(const Similarity& tool) = 0;

    /// Whether any two faces share a point.
    [[nodiscard]] virtual bool do_meet() = 0;
    /// All pairs that do, in any order, named as the contestant has it; valid until the next
    /// question.
    [[nodiscard]] virtual const std::vector<test::FacePair>& meeting() = 0;
    /// The same, and of each where the two touch, as far as the contestant keeps that.
    [[nodiscard]] virtual const std::vector<test::FacePair>& contacts() = 0;
    /// The least distance of two faces; 0 where some meet.
    [[nodiscard]] virtual double distance_m() = 0;

    /// The places of a pair in the lists that it was made of. Not timed.
    [[nodiscard]] virtual test::FacePair in_source(const test::FacePair& own) const { return own; }
    /// Drops what is kept of earlier questions.
    virtual void forget() {}
};

/// Triangles of the tool's frame and of the object's.
struct PairMeshes
{
    std::vector<Triangle> tool;
    std::vector<Triangle> object;
};

/// A peer that this build was configured with (TACTUS_BENCH_PEERS).
struct PairPeer
{
    std::string name;
    std::unique_ptr<PairQuery> (*make)(const PairMeshes& meshes);
};
[[nodiscard]] std::vector<PairPeer> pair_peers();

} // namespace tactus::bench
