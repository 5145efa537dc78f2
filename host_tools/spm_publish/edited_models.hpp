// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/edited_model.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/edit_request.hpp"
#include "transport/log.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus
{

/// The surfaces of a server's models, changed by the requests of controllers in order of arrival.
class EditedModels
{
public:
    /// Counts and volumes of one model.
    struct Counts
    {
        std::uint64_t changes{0}; ///< Requests that changed the surface.
        std::uint64_t refused{0}; ///< Requests that the surface can't take, such as a full room.
        double removed_m3{0.0};   ///< Volume that the solid lost.
        double gained_m3{0.0};    ///< Volume that the solid gained.
    };

    /// Decodes the models of the server, all of which must have a room for added faces. The server
    /// must outlive the result. `log` gets, at a limited rate, a line for each refused request.
    [[nodiscard]] static Result<EditedModels, Refusal> create(dds::DdsServer& server, Log log);

    /// Takes the requests that have arrived, changes the surfaces and publishes the edits. One
    /// change takes some milliseconds; at most kChangesAtOnce are made.
    void step();

    [[nodiscard]] const Counts& counts(std::size_t model) const { return models_[model].counts; }
    /// Number of a model's last edit; 0: none.
    [[nodiscard]] std::uint32_t revision(std::size_t model) const
    {
        return models_[model].surface.editor().revision();
    }
    [[nodiscard]] std::uint32_t added_faces(std::size_t model) const
    {
        return models_[model].surface.editor().added_count();
    }

    /// Saves a model as EditedModel::save() does.
    [[nodiscard]] Result<HeaderFields, Refusal> save(std::size_t model,
                                                     const std::filesystem::path& path,
                                                     std::vector<std::string>& notes) const
    {
        return models_[model].surface.save(path, notes);
    }

    /// Greatest number of changes in a step().
    static constexpr std::size_t kChangesAtOnce = 4;

private:
    struct Edited
    {
        EditedModel surface;
        Counts counts;
    };

    EditedModels(dds::DdsServer& server, Log log) : server_(&server), log_(std::move(log)) {}

    void change(const EditRequest& request);

    dds::DdsServer* server_;
    RateLimitedLog log_;
    std::vector<Edited> models_;
};

} // namespace tactus
