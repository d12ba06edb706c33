// A scene of what a b2World holds now.
#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/box2d/b2world.h"
#include "core/box2d/notes.h"

namespace huestep {

namespace {

Vec2 fromB2(const b2Vec2& v) {
    return {canonicalZero(v.x), canonicalZero(v.y)};
}

/// Box2D's lists hold the newest first; the order of creation is the reverse.
template <class Item>
std::vector<const Item*> inOrderOfCreation(const Item* newest) {
    std::vector<const Item*> items;
    for (const Item* item = newest; item != nullptr; item = item->GetNext()) items.push_back(item);
    std::reverse(items.begin(), items.end());
    return items;
}

/// Whether a body is nothing but what mouse joints hold on to, which have no body A here.
bool onlyHoldsMice(const b2Body& body) {
    if (body.GetType() != b2_staticBody || body.GetFixtureList() != nullptr) return false;
    const b2JointEdge* edge = body.GetJointList();
    if (edge == nullptr) return false;
    for (; edge != nullptr; edge = edge->next) {
        if (edge->joint->GetType() != e_mouseJoint || edge->joint->GetBodyA() != &body)
            return false;
    }
    return true;
}

/// The inverse of b2LinearStiffness and b2AngularStiffness: k = m ω², d = 2 m ζ ω, with m the mass
/// that both bodies share; angular: the moment of inertia, about the origins as there.
SpringDef springOf(float stiffness, float damping, float massA, float massB) {
    const float mass =
        massA > 0.0f && massB > 0.0f ? massA * massB / (massA + massB) : std::max(massA, massB);
    if (!(mass > 0.0f) || !(stiffness > 0.0f)) return {true, 0.0f, 0.0f};
    const float omega = std::sqrt(stiffness / mass);
    return {true, omega / (2.0f * std::numbers::pi_v<float>), damping / (2.0f * mass * omega)};
}

ShapeDef fromB2(const b2EdgeShape& edge) {
    if (!edge.m_oneSided) return ShapeDef::segment(fromB2(edge.m_vertex1), fromB2(edge.m_vertex2));
    return ShapeDef::chainSegment(fromB2(edge.m_vertex0), fromB2(edge.m_vertex1),
                                  fromB2(edge.m_vertex2), fromB2(edge.m_vertex3));
}

class Importer {
 public:
    Result<B2Import> import(const b2World& world, float stepSeconds);

 private:
    void addBody(const b2Body& body);
    void addShapes(const b2Fixture& fixture, BodyDef& into, const std::string& path);
    void addJoint(const b2Joint& joint, const std::string& path);
    void addRevolute(const b2RevoluteJoint& joint, JointDef def);
    void addDistance(const b2DistanceJoint& joint, JointDef def);
    void addMouse(const b2MouseJoint& joint, JointDef def);
    void addWeld(const b2WeldJoint& joint, JointDef def);
    void addPrismatic(const b2PrismaticJoint& joint, JointDef def);

    Scene m_scene;
    Notes m_notes;
    std::map<const b2Body*, std::uint32_t> m_places;  // only looked up, never walked
};

Result<B2Import> Importer::import(const b2World& world, float stepSeconds) {
    m_scene.name = "from Box2D";
    m_scene.gravity = fromB2(world.GetGravity());
    m_scene.sleep = world.GetAllowSleeping();
    m_scene.stepSeconds = stepSeconds;
    for (const b2Body* body : inOrderOfCreation(world.GetBodyList())) {
        if (!onlyHoldsMice(*body)) addBody(*body);
    }
    const auto joints = inOrderOfCreation(world.GetJointList());
    for (std::size_t i = 0; i < joints.size(); ++i) addJoint(*joints[i], pathOf("joints", i));
    if (const Status checked = check(m_scene); !checked) return checked.error();
    return B2Import{std::move(m_scene), m_notes.sentences()};
}

void Importer::addBody(const b2Body& body) {
    const std::string path = pathOf("bodies", m_scene.bodies.size());
    BodyDef def;
    def.type = body.GetType() == b2_staticBody      ? BodyType::Static
               : body.GetType() == b2_kinematicBody ? BodyType::Kinematic
                                                    : BodyType::Dynamic;
    const bool dynamic = def.type == BodyType::Dynamic;
    def.position = fromB2(body.GetPosition());
    def.rotation = {body.GetTransform().q.c, body.GetTransform().q.s};
    def.fixedRotation = body.IsFixedRotation();
    def.maySleep = body.IsSleepingAllowed();
    def.asleep = dynamic && def.maySleep && !body.IsAwake();
    if (def.type != BodyType::Static && !def.asleep) {
        def.velocity = fromB2(body.GetLinearVelocity());
        def.angularVelocity = canonicalZero(body.GetAngularVelocity());
    }
    def.linearDamping = body.GetLinearDamping();
    def.angularDamping = body.GetAngularDamping();
    def.gravityScale = body.GetGravityScale();
    if (!body.IsEnabled()) m_notes.add(path, "was disabled in Box2D, takes part here");
    if (body.IsBullet()) m_notes.add(path, "was a bullet in Box2D, is a plain body here");
    float shapeMass = 0.0f;
    const auto fixtures = inOrderOfCreation(body.GetFixtureList());
    for (std::size_t i = 0; i < fixtures.size(); ++i) {
        b2MassData mass;
        fixtures[i]->GetMassData(&mass);
        shapeMass += mass.mass;
        addShapes(*fixtures[i], def, path + "." + pathOf("fixtures", i));
    }
    if (dynamic && std::abs(shapeMass - body.GetMass()) > 1e-4f * body.GetMass()) {
        m_notes.add(path, "its mass was set by hand in Box2D, is that of its shapes here");
    }
    m_places.emplace(&body, static_cast<std::uint32_t>(m_scene.bodies.size()));
    m_scene.bodies.push_back(def);
}

void Importer::addShapes(const b2Fixture& fixture, BodyDef& into, const std::string& path) {
    if (fixture.IsSensor()) return m_notes.add(path, "is a sensor, which Huestep does not have");
    std::vector<ShapeDef> shapes;
    const b2Shape& shape = *fixture.GetShape();
    if (shape.GetType() == b2Shape::e_circle) {
        const auto& circle = static_cast<const b2CircleShape&>(shape);
        shapes.push_back(ShapeDef::circle(fromB2(circle.m_p), circle.m_radius));
    } else if (shape.GetType() == b2Shape::e_polygon) {
        const auto& polygon = static_cast<const b2PolygonShape&>(shape);
        std::vector<Vec2> points;
        for (int32 i = 0; i < polygon.m_count; ++i) points.push_back(fromB2(polygon.m_vertices[i]));
        shapes.push_back(ShapeDef::polygon(points));
    } else if (shape.GetType() == b2Shape::e_edge) {
        shapes.push_back(fromB2(static_cast<const b2EdgeShape&>(shape)));
    } else {
        const auto& chain = static_cast<const b2ChainShape&>(shape);
        for (int32 i = 0; i < chain.GetChildCount(); ++i) {
            b2EdgeShape edge;
            chain.GetChildEdge(&edge, i);
            shapes.push_back(fromB2(edge));
        }
    }
    for (ShapeDef& converted : shapes) {
        converted.density = fixture.GetDensity();
        converted.material.friction = fixture.GetFriction();
        converted.material.restitution = fixture.GetRestitution();
        const b2Filter& filter = fixture.GetFilterData();
        // All 16 bits of a mask mean "everything" there, as all 32 do here.
        converted.filter = {filter.categoryBits,
                            filter.maskBits == 0xffffu ? 0xffffffffu : filter.maskBits,
                            filter.groupIndex};
        into.shapes.push_back(converted);
    }
}

void Importer::addJoint(const b2Joint& joint, const std::string& path) {
    // Box2D's accessors of a joint's bodies are not const.
    b2Joint& source = const_cast<b2Joint&>(joint);
    JointDef def;
    if (joint.GetType() != e_mouseJoint) def.bodyA = m_places.at(source.GetBodyA());
    def.bodyB = m_places.at(source.GetBodyB());
    def.collideConnected = joint.GetCollideConnected();
    switch (joint.GetType()) {
        case e_revoluteJoint:
            return addRevolute(static_cast<const b2RevoluteJoint&>(joint), def);
        case e_distanceJoint:
            return addDistance(static_cast<const b2DistanceJoint&>(joint), def);
        case e_mouseJoint:
            return addMouse(static_cast<const b2MouseJoint&>(joint), def);
        case e_weldJoint:
            return addWeld(static_cast<const b2WeldJoint&>(joint), def);
        case e_prismaticJoint:
            return addPrismatic(static_cast<const b2PrismaticJoint&>(joint), def);
        default:
            m_notes.add(path, "is a joint of a kind that Huestep does not have");
    }
}

void Importer::addRevolute(const b2RevoluteJoint& joint, JointDef def) {
    const BodyDef& a = m_scene.bodies[def.bodyA];
    const BodyDef& b = m_scene.bodies[def.bodyB];
    def.kind = JointKind::Revolute;
    def.anchorA = fromB2(joint.GetLocalAnchorA());
    def.anchorB = fromB2(joint.GetLocalAnchorB());
    const b2Rot coordinate(joint.GetJointAngle());
    def.reference =
        relative(Rotation{coordinate.c, coordinate.s}, relative(a.rotation, b.rotation));
    def.limit = {joint.IsLimitEnabled(), joint.GetLowerLimit(), joint.GetUpperLimit()};
    def.motor = {joint.IsMotorEnabled(), joint.GetMotorSpeed(), joint.GetMaxMotorTorque()};
    m_scene.joints.push_back(def);
}

void Importer::addDistance(const b2DistanceJoint& joint, JointDef def) {
    b2DistanceJoint& source = const_cast<b2DistanceJoint&>(joint);
    def.kind = JointKind::Distance;
    def.anchorA = fromB2(joint.GetLocalAnchorA());
    def.anchorB = fromB2(joint.GetLocalAnchorB());
    def.length = joint.GetLength();
    const float low = joint.GetMinLength();
    const float high = std::min(joint.GetMaxLength(), caps::maxJointLength);
    const bool free = low < high;
    const bool springs = free && joint.GetStiffness() > 0.0f;
    const bool bounded = low > 2.0f * b2_linearSlop || high < caps::maxJointLength;
    if (springs) {
        def.spring = springOf(joint.GetStiffness(), joint.GetDamping(),
                              source.GetBodyA()->GetMass(), source.GetBodyB()->GetMass());
    }
    if (free && (bounded || !springs)) def.limit = {true, low, high};
    m_scene.joints.push_back(def);
}

void Importer::addMouse(const b2MouseJoint& joint, JointDef def) {
    b2MouseJoint& source = const_cast<b2MouseJoint&>(joint);
    def.kind = JointKind::Mouse;
    def.anchorB = fromB2(source.GetBodyB()->GetLocalPoint(joint.GetAnchorB()));
    def.target = fromB2(joint.GetTarget());
    def.maxForce = joint.GetMaxForce();
    // A mouse joint's spring carries body B alone.
    def.spring = springOf(joint.GetStiffness(), joint.GetDamping(), source.GetBodyB()->GetMass(),
                          source.GetBodyA()->GetMass());
    m_scene.joints.push_back(def);
}

void Importer::addWeld(const b2WeldJoint& joint, JointDef def) {
    b2WeldJoint& source = const_cast<b2WeldJoint&>(joint);
    def.kind = JointKind::Weld;
    def.anchorA = fromB2(joint.GetLocalAnchorA());
    def.anchorB = fromB2(joint.GetLocalAnchorB());
    const b2Rot reference(joint.GetReferenceAngle());
    def.reference = {reference.c, reference.s};
    if (joint.GetStiffness() > 0.0f) {
        def.spring = springOf(joint.GetStiffness(), joint.GetDamping(),
                              source.GetBodyA()->GetInertia(), source.GetBodyB()->GetInertia());
    }
    m_scene.joints.push_back(def);
}

void Importer::addPrismatic(const b2PrismaticJoint& joint, JointDef def) {
    def.kind = JointKind::Prismatic;
    def.anchorA = fromB2(joint.GetLocalAnchorA());
    def.anchorB = fromB2(joint.GetLocalAnchorB());
    const b2Vec2& axis = joint.GetLocalAxisA();
    def.axis = {axis.x, axis.y};
    const b2Rot reference(joint.GetReferenceAngle());
    def.reference = {reference.c, reference.s};
    def.limit = {joint.IsLimitEnabled(), joint.GetLowerLimit(), joint.GetUpperLimit()};
    def.motor = {joint.IsMotorEnabled(), joint.GetMotorSpeed(), joint.GetMaxMotorForce()};
    m_scene.joints.push_back(def);
}

}  // namespace

Result<B2Import> sceneOfB2World(const b2World& world, float stepSeconds) {
    return Importer().import(world, stepSeconds);
}

}  // namespace huestep
