fn main() -> Result<(), imp::Error> {
    imp::build(["../shared/arm.imp"])
}
