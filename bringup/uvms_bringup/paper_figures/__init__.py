"""The figures of the paper's simulations from runs of ours, with what each shows in numbers."""
