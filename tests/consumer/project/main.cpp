// What a user's first program with the library may look like: a case without any key is refused with all its faults.
#include <crossdem/case.hpp>
#include <iostream>

int main() {
  try {
    crossdem::read_case("{}");
  } catch (const crossdem::CaseError& error) {
    std::cout << "an empty case has " << error.faults().size() << " faults\n";
    return error.faults().size() > 1 ? 0 : 1;
  }
  return 1;
}
