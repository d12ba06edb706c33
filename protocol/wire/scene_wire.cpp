#include "protocol/wire/scene_wire.h"

#include "protocol/scene_file.h"

namespace huestep::protocol::wire {

namespace {

std::size_t contentWords(const ShapeDef& shape) {
    return structListWords<schema::Vec2>(shape.vertexCount);
}

void put(schema::Shape::Builder to, const ShapeDef& shape) {
    to.setKind(static_cast<schema::ShapeKind>(shape.kind));
    if (shape.vertexCount > 0) {
        auto vertices = to.initVertices(shape.vertexCount);
        for (std::uint32_t i = 0; i < vertices.size(); ++i) {
            putPoint(vertices[i], shape.vertices[i]);
        }
    }
    to.setRadius(shape.radius);
    to.setDensity(shape.density);
    auto material = to.getMaterial();
    material.setFriction(shape.material.friction);
    material.setRestitution(shape.material.restitution);
    material.setRollingResistance(shape.material.rollingResistance);
    material.setTangentSpeed(shape.material.tangentSpeed);
    auto filter = to.getFilter();
    filter.setCategory(shape.filter.category);
    filter.setMask(shape.filter.mask);
    filter.setGroup(shape.filter.group);
}

ShapeDef readShape(Reading& in, schema::Shape::Reader from) {
    ShapeDef shape;
    shape.kind = in.choice("kind", from.getKind(), ShapeKind::ChainSegment);
    const auto vertices = from.getVertices();
    const std::size_t count = in.sizeOf("vertices", vertices, maxPolygonVertices, 8);
    shape.vertexCount = static_cast<std::uint8_t>(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        shape.vertices[i] = in.at("vertices", i, [&] {
            return Vec2{in.real("x", vertices[i].getX()), in.real("y", vertices[i].getY())};
        });
    }
    shape.radius = in.real("radius", from.getRadius());
    shape.density = in.real("density", from.getDensity());
    in.at("material", [&] {
        const auto material = from.getMaterial();
        shape.material.friction = in.real("friction", material.getFriction());
        shape.material.restitution = in.real("restitution", material.getRestitution());
        shape.material.rollingResistance =
            in.real("rollingResistance", material.getRollingResistance());
        shape.material.tangentSpeed = in.real("tangentSpeed", material.getTangentSpeed());
    });
    const auto filter = from.getFilter();
    shape.filter = {filter.getCategory(), filter.getMask(), filter.getGroup()};
    return shape;
}

void put(schema::Players::Builder to, const PlayerDef& players) {
    if (players.body) wire::put(to.initBody(), *players.body);
    if (!players.spawnPoints.empty()) {
        auto points = to.initSpawnPoints(static_cast<unsigned>(players.spawnPoints.size()));
        for (unsigned i = 0; i < points.size(); ++i) putPoint(points[i], players.spawnPoints[i]);
    }
    to.setMaxSpawned(players.maxSpawned);
    to.setMaxImpulse(players.maxImpulse);
    to.setMaxForce(players.maxForce);
}

PlayerDef readPlayers(Reading& in, schema::Players::Reader from) {
    PlayerDef players;
    if (from.hasBody()) {
        players.body = in.at("body", [&] { return wire::readBody(in, from.getBody()); });
    }
    const auto points = from.getSpawnPoints();
    const std::size_t count = in.sizeOf("spawnPoints", points, caps::maxSpawnPoints, 8);
    players.spawnPoints.reserve(count);
    for (unsigned i = 0; i < count; ++i) {
        players.spawnPoints.push_back(in.at("spawnPoints", i, [&] {
            return Vec2{in.real("x", points[i].getX()), in.real("y", points[i].getY())};
        }));
    }
    players.maxSpawned = from.getMaxSpawned();
    players.maxImpulse = in.real("maxImpulse", from.getMaxImpulse());
    players.maxForce = in.real("maxForce", from.getMaxForce());
    return players;
}

void put(schema::Rules::Builder to, const RulesDef& rules) {
    to.setName(::kj::StringPtr(rules.name.c_str(), rules.name.size()));
    to.setVersion(rules.version);
    to.setSeed(rules.seed);
    if (rules.parameters.empty()) return;
    auto parameters = to.initParameters(static_cast<unsigned>(rules.parameters.size()));
    for (unsigned i = 0; i < parameters.size(); ++i) {
        const RulesParameter& parameter = rules.parameters[i];
        parameters[i].setName(::kj::StringPtr(parameter.name.c_str(), parameter.name.size()));
        parameters[i].setValue(parameter.value);
    }
}

RulesDef readRules(Reading& in, schema::Rules::Reader from) {
    const auto name = [&in](::capnp::Text::Reader text) {
        return in.text("name", {text.begin(), text.size()}, caps::maxRulesName);
    };
    RulesDef rules{name(from.getName()), from.getVersion(), from.getSeed(), {}};
    const auto parameters = from.getParameters();
    const std::size_t count = in.sizeOf("parameters", parameters, caps::maxRulesParameters,
                                        structBytes<schema::Rules::Parameter>());
    for (unsigned i = 0; i < count; ++i) {
        rules.parameters.push_back(in.at("parameters", i, [&] {
            return RulesParameter{name(parameters[i].getName()),
                                  in.real("value", parameters[i].getValue())};
        }));
    }
    return rules;
}

std::size_t contentWords(const RulesDef& rules) {
    std::size_t words =
        textWords(rules.name) + structListWords<schema::Rules::Parameter>(rules.parameters.size());
    for (const RulesParameter& parameter : rules.parameters) words += textWords(parameter.name);
    return words;
}

void putLimits(schema::Scene::Builder to, const Scene& scene) {
    auto limits = to.getLimits();
    limits.setBodies(scene.limits.bodies);
    limits.setShapes(scene.limits.shapes);
    limits.setJoints(scene.limits.joints);
    limits.setCommandsPerTick(scene.limits.commandsPerTick);
    limits.setPlayers(scene.limits.players);
    auto counters = to.getCounters();
    counters.setNextBody(scene.counters.nextBody);
    counters.setNextShape(scene.counters.nextShape);
    counters.setNextJoint(scene.counters.nextJoint);
}

}  // namespace

std::size_t contentWords(const BodyDef& body) {
    std::size_t words = structListWords<schema::Shape>(body.shapes.size());
    for (const ShapeDef& shape : body.shapes) words += contentWords(shape);
    return words;
}

std::size_t contentWords(const Scene& scene) {
    std::size_t words = textWords(scene.name) + structListWords<schema::Body>(scene.bodies.size()) +
                        structListWords<schema::Joint>(scene.joints.size());
    for (const BodyDef& body : scene.bodies) words += contentWords(body);
    if (scene.players) {
        words += structWords<schema::Players>() +
                 structListWords<schema::Vec2>(scene.players->spawnPoints.size());
        if (const auto& body = scene.players->body) {
            words += structWords<schema::Body>() + contentWords(*body);
        }
    }
    if (scene.rules) words += structWords<schema::Rules>() + contentWords(*scene.rules);
    return words;
}

void put(schema::Body::Builder to, const BodyDef& body) {
    to.setId(body.id);
    to.setFirstShape(body.firstShape);
    to.setType(static_cast<schema::BodyType>(body.type));
    to.setFixedRotation(body.fixedRotation);
    to.setMaySleep(body.maySleep);
    to.setAsleep(body.asleep);
    putPoint(to.getPosition(), body.position);
    putRotation(to.getRotation(), body.rotation);
    putPoint(to.getVelocity(), body.velocity);
    to.setAngularVelocity(body.angularVelocity);
    to.setLinearDamping(body.linearDamping);
    to.setAngularDamping(body.angularDamping);
    to.setGravityScale(body.gravityScale);
    if (body.shapes.empty()) return;
    auto shapes = to.initShapes(static_cast<unsigned>(body.shapes.size()));
    for (unsigned i = 0; i < shapes.size(); ++i) put(shapes[i], body.shapes[i]);
}

BodyDef readBody(Reading& in, schema::Body::Reader from) {
    BodyDef body;
    body.id = from.getId();
    body.firstShape = from.getFirstShape();
    body.type = in.choice("type", from.getType(), BodyType::Dynamic);
    body.fixedRotation = from.getFixedRotation();
    body.maySleep = from.getMaySleep();
    body.asleep = from.getAsleep();
    body.position = in.point("position", from.getPosition());
    body.rotation = in.rotation("rotation", from.getRotation());
    body.velocity = in.point("velocity", from.getVelocity());
    body.angularVelocity = in.real("angularVelocity", from.getAngularVelocity());
    body.linearDamping = in.real("linearDamping", from.getLinearDamping());
    body.angularDamping = in.real("angularDamping", from.getAngularDamping());
    body.gravityScale = in.real("gravityScale", from.getGravityScale());
    const auto shapes = from.getShapes();
    const std::size_t count =
        in.sizeOf("shapes", shapes, maxShapesPerBody, structBytes<schema::Shape>());
    body.shapes.reserve(count);
    for (unsigned i = 0; i < count; ++i) {
        body.shapes.push_back(in.at("shapes", i, [&] { return readShape(in, shapes[i]); }));
    }
    return body;
}

void put(schema::Joint::Builder to, const JointDef& joint) {
    to.setId(joint.id);
    to.setKind(static_cast<schema::JointKind>(joint.kind));
    to.setCollideConnected(joint.collideConnected);
    to.setBodyA(joint.bodyA);
    to.setBodyB(joint.bodyB);
    putPoint(to.getAnchorA(), joint.anchorA);
    putPoint(to.getAnchorB(), joint.anchorB);
    putRotation(to.getReference(), joint.reference);
    putRotation(to.getAxis(), joint.axis);
    to.setLength(joint.length);
    putPoint(to.getTarget(), joint.target);
    to.setMaxForce(joint.maxForce);
    auto spring = to.getSpring();
    spring.setEnabled(joint.spring.enabled);
    spring.setHertz(joint.spring.hertz);
    spring.setDampingRatio(joint.spring.dampingRatio);
    auto limit = to.getLimit();
    limit.setEnabled(joint.limit.enabled);
    limit.setLower(joint.limit.lower);
    limit.setUpper(joint.limit.upper);
    auto motor = to.getMotor();
    motor.setEnabled(joint.motor.enabled);
    motor.setSpeed(joint.motor.speed);
    motor.setMaxEffort(joint.motor.maxEffort);
}

JointDef readJoint(Reading& in, schema::Joint::Reader from) {
    JointDef joint;
    joint.id = from.getId();
    joint.kind = in.choice("kind", from.getKind(), JointKind::Prismatic);
    joint.collideConnected = from.getCollideConnected();
    joint.bodyA = from.getBodyA();
    joint.bodyB = from.getBodyB();
    joint.anchorA = in.point("anchorA", from.getAnchorA());
    joint.anchorB = in.point("anchorB", from.getAnchorB());
    joint.reference = in.rotation("reference", from.getReference());
    joint.axis = in.rotation("axis", from.getAxis());
    joint.length = in.real("length", from.getLength());
    joint.target = in.point("target", from.getTarget());
    joint.maxForce = in.real("maxForce", from.getMaxForce());
    in.at("spring", [&] {
        const auto spring = from.getSpring();
        joint.spring = {spring.getEnabled(), in.real("hertz", spring.getHertz()),
                        in.real("dampingRatio", spring.getDampingRatio())};
    });
    in.at("limit", [&] {
        const auto limit = from.getLimit();
        joint.limit = {limit.getEnabled(), in.real("lower", limit.getLower()),
                       in.real("upper", limit.getUpper())};
    });
    in.at("motor", [&] {
        const auto motor = from.getMotor();
        joint.motor = {motor.getEnabled(), in.real("speed", motor.getSpeed()),
                       in.real("maxEffort", motor.getMaxEffort())};
    });
    return joint;
}

std::vector<BodyDef> readBodies(Reading& in, ::capnp::List<schema::Body>::Reader from,
                                std::size_t most) {
    const std::size_t count = in.sizeOf("bodies", from, most, structBytes<schema::Body>());
    std::vector<BodyDef> bodies;
    bodies.reserve(count);
    for (unsigned i = 0; i < count; ++i) {
        bodies.push_back(in.at("bodies", i, [&] { return readBody(in, from[i]); }));
    }
    return bodies;
}

std::vector<JointDef> readJoints(Reading& in, ::capnp::List<schema::Joint>::Reader from,
                                 std::size_t most) {
    const std::size_t count = in.sizeOf("joints", from, most, structBytes<schema::Joint>());
    std::vector<JointDef> joints;
    joints.reserve(count);
    for (unsigned i = 0; i < count; ++i) {
        joints.push_back(in.at("joints", i, [&] { return readJoint(in, from[i]); }));
    }
    return joints;
}

void put(schema::Scene::Builder to, const Scene& scene) {
    to.setVersion(sceneVersion);
    if (!scene.name.empty()) to.setName(::kj::StringPtr(scene.name.c_str(), scene.name.size()));
    putPoint(to.getGravity(), scene.gravity);
    to.setStepSeconds(scene.stepSeconds);
    to.setSubsteps(scene.substeps);
    to.getNeed().setPenetration(scene.need.penetration);
    to.getNeed().setJoint(scene.need.joint);
    to.setMethod(static_cast<schema::Method>(scene.method));
    to.setSleep(scene.sleep);
    if (!scene.bodies.empty()) {
        auto bodies = to.initBodies(static_cast<unsigned>(scene.bodies.size()));
        for (unsigned i = 0; i < bodies.size(); ++i) put(bodies[i], scene.bodies[i]);
    }
    if (!scene.joints.empty()) {
        auto joints = to.initJoints(static_cast<unsigned>(scene.joints.size()));
        for (unsigned i = 0; i < joints.size(); ++i) put(joints[i], scene.joints[i]);
    }
    if (scene.players) put(to.initPlayers(), *scene.players);
    putLimits(to, scene);
    if (scene.rules) put(to.initRules(), *scene.rules);
}

Scene readScene(Reading& in, schema::Scene::Reader from) {
    if (from.getVersion() != sceneVersion) {
        in.refuse("version", "is " + std::to_string(from.getVersion()) +
                                 ", this program reads version " + std::to_string(sceneVersion));
    }
    Scene scene;
    const auto name = from.getName();
    scene.name = in.text("name", {name.begin(), name.size()}, caps::maxSceneName);
    scene.gravity = in.point("gravity", from.getGravity());
    scene.stepSeconds = in.real("stepSeconds", from.getStepSeconds());
    scene.substeps = from.getSubsteps();
    scene.need.penetration = in.real("need.penetration", from.getNeed().getPenetration());
    scene.need.joint = in.real("need.joint", from.getNeed().getJoint());
    scene.method = in.choice("method", from.getMethod(), lastMethod);
    scene.sleep = from.getSleep();
    scene.bodies = readBodies(in, from.getBodies(), caps::maxBodies);
    scene.joints = readJoints(in, from.getJoints(), caps::maxJoints);
    if (from.hasPlayers()) {
        scene.players = in.at("players", [&] { return readPlayers(in, from.getPlayers()); });
    }
    if (from.hasRules()) {
        scene.rules = in.at("rules", [&] { return readRules(in, from.getRules()); });
    }
    const auto limits = from.getLimits();
    scene.limits = {limits.getBodies(), limits.getShapes(), limits.getJoints(),
                    limits.getCommandsPerTick(), limits.getPlayers()};
    const auto counters = from.getCounters();
    scene.counters = {counters.getNextBody(), counters.getNextShape(), counters.getNextJoint()};
    return scene;
}

}  // namespace huestep::protocol::wire
