#include "core/world/command.h"

#include <algorithm>

namespace huestep {

void sortByKey(std::vector<Command>& commands) {
    std::stable_sort(commands.begin(), commands.end(), [](const Command& a, const Command& b) {
        return a.author != b.author ? a.author < b.author : a.sequence < b.sequence;
    });
}

std::string_view describe(Rejection reason) {
    switch (reason) {
        case Rejection::None:
            return "applied";
        case Rejection::UnknownAuthor:
            return "the author is no player of this world";
        case Rejection::NotAllowed:
            return "the author may not do this";
        case Rejection::OldSequence:
            return "the sequence is not above the author's last";
        case Rejection::UnknownBody:
            return "there is no such body";
        case Rejection::UnknownJoint:
            return "there is no such joint";
        case Rejection::WrongBodyType:
            return "the body is of the wrong type for this";
        case Rejection::NotFinite:
            return "a number is not finite or out of range";
        case Rejection::TooStrong:
            return "the impulse or force is above the scene's cap";
        case Rejection::BadDefinition:
            return "the definition is not valid";
        case Rejection::OverBudget:
            return "the author's spawn budget is used up";
        case Rejection::OverLimit:
            return "a limit of the world is reached";
        case Rejection::NothingGrabbed:
            return "the author holds nothing";
        case Rejection::NoMotor:
            return "the joint has no motor";
        case Rejection::PlayerExists:
            return "the player is already there";
        case Rejection::TooFar:
            return "the point is too far from the body";
        case Rejection::UnknownAction:
            return "the world's rules know no such action";
        case Rejection::AgainstRules:
            return "the rules do not allow it, or not now";
        case Rejection::TooCrowded:
            return "too much is there already";
    }
    return "unknown reason";
}

}  // namespace huestep
