// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording_format.hpp"

#include <bit>

namespace tactus
{

namespace
{

// A field added to one of these types must be hashed below.
static_assert(sizeof(ToolOutput) == 256);
static_assert(sizeof(PairOutput) == 232);
static_assert(sizeof(Contact) == 96);
static_assert(sizeof(MeshReport) == 8 * kMaxMeetingFaces + 24);
static_assert(sizeof(ModelOutput) == 96);
static_assert(sizeof(WorkCounters) == 64 + 4 * kSkips);
static_assert(sizeof(SceneOutput) == 20 + 4 * kChangeRefusals + 4 * kEditRefusals);

class Hash
{
public:
    void add(std::uint64_t value) noexcept
    {
        // The finalizer of SplitMix64: every bit of the input affects every bit of the state.
        state_ = (state_ ^ value) + 0x9E37'79B9'7F4A'7C15ULL;
        state_ = (state_ ^ (state_ >> 30U)) * 0xBF58'476D'1CE4'E5B9ULL;
        state_ = (state_ ^ (state_ >> 27U)) * 0x94D0'49BB'1331'11EBULL;
        state_ ^= state_ >> 31U;
    }
    void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value)); }
    void add(const Vec3& value) noexcept
    {
        add(value.x());
        add(value.y());
        add(value.z());
    }
    void add(const Mat3& value) noexcept
    {
        for (int row = 0; row < 3; ++row)
        {
            add(Vec3(value.row(row)));
        }
    }
    void add(const PoolUse& use) noexcept
    {
        add(std::uint64_t{use.used});
        add(std::uint64_t{use.used_max});
        add(std::uint64_t{use.capacity});
    }
    [[nodiscard]] std::uint64_t value() const noexcept { return state_; }

private:
    std::uint64_t state_{0};
};

std::uint64_t hash_tools(std::span<const ToolOutput> tools) noexcept
{
    Hash hash;
    for (const ToolOutput& tool : tools)
    {
        hash.add(tool.force_n);
        hash.add(tool.proxy_m);
        hash.add(tool.torque_nm);
        hash.add(tool.proxy_rotation);
        hash.add(std::uint64_t{tool.in_contact});
        hash.add(std::uint64_t{tool.halted});
        hash.add(std::uint64_t{tool.over_constrained});
        hash.add(std::uint64_t{tool.data_limited});
        hash.add(std::uint64_t{tool.under_way});
        hash.add(std::uint64_t{tool.cut_short});
        hash.add(std::uint64_t{tool.capacity_exceeded});
        hash.add(std::uint64_t{tool.lost_object});
        hash.add(std::uint64_t{tool.is_gone});
        hash.add(tool.clear_m);
        hash.add(tool.stiffness_n_per_m);
        hash.add(tool.lag_m);
        hash.add(tool.object_way_m);
        hash.add(tool.object_rotation_rad);
        hash.add(tool.carried_m);
        hash.add(tool.carried_rad);
        hash.add(static_cast<std::uint64_t>(tool.sample_fault));
    }
    return hash.value();
}

void hash_contacts(Hash& hash, const ContactReport& report) noexcept
{
    for (const Contact& contact : report.contacts)
    {
        hash.add(std::uint64_t{contact.face.value});
        hash.add(static_cast<std::uint64_t>(contact.feature));
        hash.add(contact.distance_m);
        hash.add(contact.on_tool_m);
        hash.add(contact.on_surface_m);
        hash.add(contact.normal);
        hash.add(std::uint64_t{contact.tool_face.value});
    }
    hash.add(std::uint64_t{report.is_complete});
    hash.add(std::uint64_t{report.overruled});
    hash.add(report.normal);
    hash.add(static_cast<std::uint64_t>(report.side));
}

void hash_mesh(Hash& hash, const MeshReport& report) noexcept
{
    hash.add(static_cast<std::uint64_t>(report.intersection));
    for (const MeetingFaces& faces : report.meeting)
    {
        hash.add((std::uint64_t{faces.tool_face.value} << 32U) | faces.face.value);
    }
    hash.add(std::uint64_t{report.is_truncated});
    hash.add(std::uint64_t{report.is_complete});
    hash.add(std::uint64_t{report.nearest_tool_face.value});
}

std::uint64_t hash_pairs(std::span<const PairOutput> pairs) noexcept
{
    Hash hash;
    for (const PairOutput& pair : pairs)
    {
        hash.add((std::uint64_t{pair.tool} << 32U) | pair.object);
        hash.add(static_cast<std::uint64_t>(pair.kind));
        hash.add(pair.tool_m);
        hash.add(pair.tool_rotation);
        hash.add(pair.point_m);
        hash.add(pair.lower_m);
        hash.add(pair.upper_m);
        hash.add(pair.certified_radius_m);
        hash.add(pair.tolerated_m);
        hash.add(std::uint64_t{pair.nearest_face.value});
        hash.add(pair.nearest_point_m);
        hash.add(std::uint64_t{pair.skipped});
        hash.add(std::uint64_t{pair.is_shed});
        hash.add(std::uint64_t{pair.is_joined});
        hash.add(pair.damping_n_s_per_m);
        hash.add(static_cast<std::uint64_t>(pair.nearest_feature));
        if (pair.contacts != nullptr)
        {
            hash_contacts(hash, *pair.contacts);
        }
        if (pair.mesh != nullptr)
        {
            hash_mesh(hash, *pair.mesh);
        }
    }
    return hash.value();
}

std::uint64_t hash_models(std::span<const ModelOutput> models) noexcept
{
    Hash hash;
    for (const ModelOutput& model : models)
    {
        hash.add(model.pages);
        hash.add(model.index_pages);
        hash.add(model.faces);
        hash.add(model.blocks);
        hash.add(model.nodes);
        hash.add(std::uint64_t{model.refined_records});
        hash.add(model.state_hash);
        hash.add(std::uint64_t{model.is_static});
        if (model.stage != ModelStage::resident)
        {
            hash.add(static_cast<std::uint64_t>(model.stage));
        }
        if (model.added.capacity != 0)
        {
            hash.add(model.added);
            hash.add(std::uint64_t{model.edit_revision});
        }
    }
    return hash.value();
}

std::uint64_t hash_work(const WorkCounters& work, const SceneOutput& scene,
                        FrameFault faults) noexcept
{
    Hash hash;
    for (const std::uint32_t count :
         {work.splits, work.merges, work.scanned, work.nodes_visited, work.triangles_tested,
          work.planes_looked_at, work.pages_adopted, work.requests, work.regions_searched,
          work.nodes_refitted, work.blocks_refitted, work.evictions, work.cache_hits,
          work.cache_misses, work.budget.used()})
    {
        hash.add(std::uint64_t{count});
    }
    for (const std::uint32_t count :
         {scene.objects, scene.pairs, scene.tools_over_capacity, scene.walled_tools, scene.walks})
    {
        hash.add(std::uint64_t{count});
    }
    for (const std::uint32_t times : scene.refused)
    {
        hash.add(std::uint64_t{times});
    }
    for (const std::uint32_t times : scene.edits_refused)
    {
        hash.add(std::uint64_t{times});
    }
    for (const std::uint32_t times : work.skipped.times())
    {
        hash.add(std::uint64_t{times});
    }
    hash.add(static_cast<std::uint64_t>(faults));
    return hash.value();
}

} // namespace

OutputHashes hash_output(const FrameOutput& output) noexcept
{
    return {hash_tools(output.tools), hash_pairs(output.pairs), hash_models(output.models),
            hash_work(output.work, output.scene, output.faults)};
}

} // namespace tactus
