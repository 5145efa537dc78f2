// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Errors of faces, and the greatest depth.

#include "host_tools/encode/face_history.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <set>

namespace tactus
{

namespace
{

TEST(FaceHistory, only_faces_of_the_source_have_error_zero)
{
    for (const auto& model : sample_models())
    {
        const QuantisedMesh& mesh = model->prepared.mesh;
        const Numbering numbering = number_model(mesh, model->simplification);
        const FaceHistory sut = trace_faces(mesh, model->simplification, numbering);
        // Collapses replayed on corners: a face is original while it has its own corners.
        std::set<std::uint32_t> changed;
        for (const Collapse& collapse : model->simplification.collapses)
        {
            const StarHistory& star = sut.stars[numbering.record_of(collapse).value];
            for (std::uint32_t place = 0; place < 2 + collapse.fan_size; ++place)
            {
                if (collapse.star[place] == Collapse::kNoFace)
                {
                    continue;
                }
                EXPECT_EQ(star.error_after[place] == 0, changed.count(collapse.star[place]) == 0)
                    << model->name << ", face " << collapse.star[place];
                if (changed.count(collapse.star[place]) != 0)
                {
                    EXPECT_GE(static_cast<double>(error_in_quanta(star.error_after[place])),
                              collapse.error[place]);
                }
                if (place >= 2)
                {
                    changed.insert(collapse.star[place]);
                    EXPECT_NE(star.error_before[place - 2], 0) << model->name;
                }
            }
        }
        for (std::uint32_t id = 0; id < numbering.counts.base_faces; ++id)
        {
            const std::uint32_t at = numbering.base_faces[id];
            const bool is_changed = changed.count(model->simplification.base_faces[at]) != 0;
            EXPECT_EQ(sut.base_error[id] != 0, is_changed) << model->name << ", base face " << id;
            EXPECT_GE(static_cast<double>(error_in_quanta(sut.base_error[id])),
                      model->simplification.base_error[at] * (is_changed ? 1.0F : 0.0F));
        }
    }
}

TEST(FaceHistory, names_the_greatest_bound_and_depth_of_all)
{
    for (const auto& model : sample_models())
    {
        const Numbering numbering = number_model(model->prepared.mesh, model->simplification);
        const FaceHistory sut = trace_faces(model->prepared.mesh, model->simplification, numbering);
        std::uint32_t depth = 0;
        ErrorCode error = 0;
        for (const StarHistory& star : sut.stars)
        {
            depth = std::max(depth, star.depth);
            for (const ErrorCode code : star.error_before)
            {
                error = std::max(error, code);
            }
        }
        for (const ErrorCode code : sut.base_error)
        {
            error = std::max(error, code);
        }
        EXPECT_EQ(sut.max_depth, depth) << model->name;
        EXPECT_EQ(sut.max_error, error) << model->name;
        EXPECT_LE(depth, model->simplification.rounds) << model->name;
    }
}

} // namespace

} // namespace tactus
