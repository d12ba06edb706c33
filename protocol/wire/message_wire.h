/// Each message to Cap'n Proto and back: what codec.cpp dispatches to.
#pragma once

#include "protocol/messages.capnp.h"
#include "protocol/messages.h"
#include "protocol/wire/reading.h"

namespace huestep::protocol::wire {

/// Words of what the message points to, its root struct aside.
std::size_t contentWords(const Hello& message);
std::size_t contentWords(const Welcome& message);
std::size_t contentWords(const Intent& message);
std::size_t contentWords(const Frame& message);
std::size_t contentWords(const SnapshotChunk& message);
std::size_t contentWords(const HashNodes& message);
std::size_t contentWords(const DesyncReport& message);
std::size_t contentWords(const Bye& message);
std::size_t contentWords(const View& message);
template <class Message>
std::size_t contentWords(const Message&) {
    return 0;
}

void put(schema::Hello::Builder to, const Hello& message);
void put(schema::Welcome::Builder to, const Welcome& message);
void put(schema::Intent::Builder to, const Intent& message);
void put(schema::Frame::Builder to, const Frame& message);
void put(schema::SnapshotBegin::Builder to, const SnapshotBegin& message);
void put(schema::SnapshotChunk::Builder to, const SnapshotChunk& message);
void put(schema::SnapshotEnd::Builder to, const SnapshotEnd& message);
void put(schema::SnapshotRequest::Builder to, const SnapshotRequest& message);
void put(schema::HashQuery::Builder to, const HashQuery& message);
void put(schema::HashNodes::Builder to, const HashNodes& message);
void put(schema::DesyncReport::Builder to, const DesyncReport& message);
void put(schema::Ping::Builder to, const Ping& message);
void put(schema::Bye::Builder to, const Bye& message);
void put(schema::View::Builder to, const View& message);

Hello read(Reading& in, schema::Hello::Reader from);
Welcome read(Reading& in, schema::Welcome::Reader from);
Intent read(Reading& in, schema::Intent::Reader from);
Frame read(Reading& in, schema::Frame::Reader from);
SnapshotBegin read(Reading& in, schema::SnapshotBegin::Reader from);
SnapshotChunk read(Reading& in, schema::SnapshotChunk::Reader from);
SnapshotEnd read(Reading& in, schema::SnapshotEnd::Reader from);
SnapshotRequest read(Reading& in, schema::SnapshotRequest::Reader from);
HashQuery read(Reading& in, schema::HashQuery::Reader from);
HashNodes read(Reading& in, schema::HashNodes::Reader from);
DesyncReport read(Reading& in, schema::DesyncReport::Reader from);
Ping read(Reading& in, schema::Ping::Reader from);
Bye read(Reading& in, schema::Bye::Reader from);
View read(Reading& in, schema::View::Reader from);

}  // namespace huestep::protocol::wire
