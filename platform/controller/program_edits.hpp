// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

class EditMailbox;

} // namespace tactus

namespace tactus::hrtc
{

class CutTap;

/// Edits of a program's own models. All must outlive the run.
struct ProgramEdits
{
    EditMailbox* mailbox{nullptr}; ///< Null if no model can be edited, or a server does it.
    CutTap* cuts{nullptr};         ///< Null if no tool carves.
};

} // namespace tactus::hrtc
