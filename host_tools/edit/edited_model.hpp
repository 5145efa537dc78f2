// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/surface_editor.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"
#include "transport/edit_request.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tactus
{

/// Sweep of the tool of a request. The tool keeps the rotation of its first place.
[[nodiscard]] Sweep sweep_of(const EditRequest& request);

/// A model of a file while it is edited; a value. Threads as for SurfaceEditor.
class EditedModel
{
public:
    /// Decodes the model of a store. `room` is the number of slots for added faces.
    [[nodiscard]] static Result<EditedModel, Refusal> create(const ModelStore& store,
                                                             std::uint32_t room);

    [[nodiscard]] SurfaceEditor& editor() noexcept { return editor_; }
    [[nodiscard]] const SurfaceEditor& editor() const noexcept { return editor_; }
    /// Changes the surface as the request says.
    [[nodiscard]] Result<SurfaceChange, Refusal> change(const EditRequest& request);

    /// Builds the model with its edits as one file, whose revision is that of the store's file plus
    /// the number of edits. The path gets the whole file or none. `notes` gets the builder's notes.
    [[nodiscard]] Result<HeaderFields, Refusal> save(const std::filesystem::path& path,
                                                     std::vector<std::string>& notes) const;

private:
    EditedModel(SurfaceEditor editor, const ModelStore& store)
        : editor_(std::move(editor))
        , fields_(store.header().fields())
        , quantum_m_(static_cast<double>(store.header().quantum_m()))
        , source_(store.path().string())
    {
    }

    SurfaceEditor editor_;
    HeaderFields fields_;
    double quantum_m_;
    std::string source_;
};

} // namespace tactus
