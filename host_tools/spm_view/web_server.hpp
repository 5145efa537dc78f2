// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/film.hpp"
#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/model_shelf.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace tactus::view
{

/// The page and what it asks for, on this machine's loopback only (docs/view.md). It reads and
/// never writes: there is nothing in it that could change a controller.
class WebServer
{
public:
    /// Browsers that may listen to events at once; each holds a thread.
    static constexpr std::size_t kViewersMax = 4;
    /// Threads that answer: with all viewers there, four are left for everything else.
    static constexpr std::size_t kThreads = kViewersMax + 4;

    struct Parts
    {
        const LiveState& live;
        ModelShelf& shelf;
        std::uint32_t domain{0};         ///< Told on the page.
        std::filesystem::path libraries; ///< The folder with three and dygraphs.
        const Films* films{nullptr};     ///< To be shown in place of what is live; may be null.
    };

    /// Listens on 127.0.0.1 until it is destroyed, which takes some 100 ms. `parts` outlive it.
    /// Port 0: any that is free. Refused when the port can't be had or a library's file isn't
    /// there.
    [[nodiscard]] static Result<std::unique_ptr<WebServer>, Refusal> start(const Parts& parts,
                                                                           std::uint16_t port);
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;
    ~WebServer();

    [[nodiscard]] std::uint16_t port() const noexcept;

private:
    struct Inside; ///< The only place that knows cpp-httplib.

    explicit WebServer(std::unique_ptr<Inside> inside);

    std::unique_ptr<Inside> inside_;
};

} // namespace tactus::view
