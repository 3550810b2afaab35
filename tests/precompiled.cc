// Nothing: a program from which the tests have their precompiled header.
int main() {}
