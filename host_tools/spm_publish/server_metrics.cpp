// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/server_metrics.hpp"

#include "host_tools/web/prometheus_text.hpp"
#include "transport/content_hash.hpp"

#include <cstdint>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::chrono::seconds kPeriod{1};

void tell_models(web::PrometheusText& text, const dds::DdsServer& server)
{
    const auto tell = [&](const char* name, const char* help, auto value)
    {
        text.family(name, "gauge", help);
        for (const dds::ModelPieces& model : server.models())
        {
            text.sample({{"model", model.model().name}, {"hash", hash_text(model.store().hash())}},
                        static_cast<double>(value(model.store().header().fields())));
        }
    };
    tell("tactus_model_faces", "Faces of the source mesh of a served model.",
         [](const HeaderFields& fields) { return fields.source_faces; });
    tell("tactus_model_bytes", "Bytes of the file of a served model.",
         [](const HeaderFields& fields) { return fields.file_bytes; });
}

void tell_subscribers(web::PrometheusText& text, const dds::DdsServer& server)
{
    const std::vector<dds::DdsServer::Subscriber> subscribers = server.subscribers();
    const auto tell = [&](const char* name, const char* help, auto value)
    {
        text.family(name, "counter", help);
        for (const dds::DdsServer::Subscriber& subscriber : subscribers)
        {
            text.sample({{"subscriber", subscriber.controller}},
                        static_cast<double>(value(subscriber)));
        }
    };
    tell("tactus_subscriber_pieces_sent_total", "Pieces sent to a subscribed controller.",
         [](const auto& subscriber) { return subscriber.pieces_sent; });
    tell("tactus_subscriber_bytes_sent_total", "Payload bytes sent to a subscribed controller.",
         [](const auto& subscriber) { return subscriber.bytes_sent; });
}

void tell_edits(web::PrometheusText& text, dds::DdsServer& server, const EditedModels& edited)
{
    const auto tell = [&](const char* name, const char* type, const char* help, auto value)
    {
        text.family(name, type, help);
        for (std::size_t i = 0; i < server.models().size(); ++i)
        {
            text.sample({{"model", server.models()[i].model().name}},
                        static_cast<double>(value(i)));
        }
    };
    tell("tactus_model_edits_total", "counter", "Edits of a model's surface.",
         [&](std::size_t i) { return edited.revision(i); });
    tell("tactus_model_added_faces", "gauge", "Faces that edits added to a model.",
         [&](std::size_t i) { return edited.added_faces(i); });
    tell("tactus_model_edits_refused_total", "counter",
         "Edit requests that a model's surface could not take.",
         [&](std::size_t i) { return edited.counts(i).refused; });
    tell("tactus_model_removed_cubic_metres_total", "counter",
         "Volume that edits removed from a model.",
         [&](std::size_t i) { return edited.counts(i).removed_m3; });
    const dds::EditPublisher::Counters& counters = server.edits()->counters();
    const auto tell_one = [&text](const char* name, const char* help, std::uint64_t value)
    {
        text.family(name, "counter", help);
        text.sample({}, static_cast<double>(value));
    };
    tell_one("tactus_edit_requests_total", "Accepted edit requests of controllers.",
             counters.requests);
    tell_one("tactus_edit_requests_refused_total", "Refused edit requests of controllers.",
             counters.requests_refused);
    tell_one("tactus_edit_bytes_sent_total", "Payload bytes of edits and their sums.",
             counters.bytes);
}

} // namespace

std::string server_metrics(dds::DdsServer& server, const dds::TelemetryReader& controllers,
                           const EditedModels* edited)
{
    web::PrometheusText text;
    const dds::DdsServer::Counters counters = server.counters();
    const auto tell =
        [&text](const char* name, const char* type, const char* help, std::uint64_t value)
    {
        text.family(name, type, help);
        text.sample({}, static_cast<double>(value));
    };
    tell("tactus_pieces_sent_total", "counter", "Pieces of models sent to controllers.",
         counters.pieces_sent);
    tell("tactus_bytes_sent_total", "counter", "Payload bytes sent to controllers.",
         counters.bytes_sent);
    tell("tactus_requests_total", "counter", "Requests from controllers.", counters.requests);
    tell("tactus_requests_refused_total", "counter", "Refused requests from controllers.",
         counters.requests_refused);
    tell("tactus_writers_renewed_total", "counter",
         "Replacements of DDS writers that did not reach their controllers.", counters.renewed);
    tell("tactus_participants", "gauge", "DDS participants on the domain.",
         server.domain().participants().count());
    tell("tactus_subscribers", "gauge", "Controllers served by this server.",
         server.subscribers().size());
    tell("tactus_objects_shown", "gauge", "Objects shown by this server.",
         server.objects().objects());
    tell_models(text, server);
    tell_subscribers(text, server);
    if (edited != nullptr)
    {
        tell_edits(text, server, *edited);
    }
    std::vector<const dds::WatchedController*> watched;
    for (const dds::WatchedController& controller : controllers.controllers())
    {
        watched.push_back(&controller);
    }
    web::tell_controllers(text, watched);
    return text.text();
}

void ServerMetrics::update(dds::DdsServer& server, const dds::TelemetryReader& controllers,
                           const EditedModels* edited)
{
    const auto now = Clock::now();
    if (now - last_ >= kPeriod)
    {
        last_ = now;
        page_->publish(server_metrics(server, controllers, edited));
    }
}

} // namespace tactus
