"""The paper's results, claim by claim and figure by figure: what it says, what comes out here, and the number that tells."""
